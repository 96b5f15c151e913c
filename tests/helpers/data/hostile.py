"""Small files that would take gigabytes of memory, or minutes, of whoever believes what they claim."""

from __future__ import annotations

import gzip
import lzma
import zipfile
from collections.abc import Callable, Iterable
from pathlib import Path

MEGABYTE = 1_000_000
CONTENT = {
    "xl/_rels/workbook.xml.rels": '<Relationships xmlns="r">'
    '<Relationship Id="a" Type="x/worksheet" Target="worksheets/sheet1.xml"/>'
    '<Relationship Id="b" Type="x/sharedStrings" Target="sharedStrings.xml"/></Relationships>',
    "xl/workbook.xml": '<workbook xmlns:r="r"><sheets><sheet name="walk" sheetId="1" r:id="a"/></sheets></workbook>',
    "xl/sharedStrings.xml": "<sst><si><t>t</t></si></sst>",
    "xl/worksheets/sheet1.xml": "<worksheet><sheetData>{}</sheetData></worksheet>",
}
"""Parts of a workbook, as far as they are needed."""
SHEET, TEXTS = "xl/worksheets/sheet1.xml", "xl/sharedStrings.xml"
HEADER = "".join(f'<c t="inlineStr"><is><t>{name}</t></is></c>' for name in ("t", "acc_x", "acc_y", "acc_z"))
ROWS = f"<row>{HEADER}</row>" + "".join(
    f"<row><c><v>{k / 100}</v></c><c><v>0</v></c><c><v>0</v></c><c><v>9.8</v></c></row>" for k in range(200)
)


def workbook(path: Path, **parts: Iterable[str]) -> Path:
    """Write a workbook whose parts `texts` and `sheet` (what is in its sheetData) are these pieces of XML."""
    names = {"sheet": SHEET, "texts": TEXTS}
    given = {names[name]: pieces for name, pieces in parts.items()}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, text in CONTENT.items():
            before, _, after = text.partition("{}")
            pieces = given.get(name, [ROWS] if name == SHEET else [])
            with archive.open(name, "w") as file:
                if name == TEXTS and pieces:
                    before = after = ""
                for piece in (before, *pieces, after):
                    file.write(piece.encode())
    return path


def lying(path: Path) -> Path:
    """Write a workbook whose directory says that its sheet is small, which it is not."""
    workbook(path, sheet=[ROWS, *[" " * MEGABYTE] * 100])
    with zipfile.ZipFile(path) as archive:
        size = archive.getinfo(SHEET).file_size
    path.write_bytes(path.read_bytes().replace(size.to_bytes(4, "little"), (5000).to_bytes(4, "little")))
    return path


def parquet(path: Path, count: int, names: str) -> Path:
    """Write a Parquet file of so many million rows of zeros."""
    import numpy as np
    import pyarrow
    from pyarrow.parquet import ParquetWriter

    zeros = np.zeros(MEGABYTE)
    table = pyarrow.table({name: zeros for name in names.split()})
    with ParquetWriter(path, table.schema) as writer:
        for _ in range(count):
            writer.write_table(table, row_group_size=MEGABYTE)
    return path


def parquet_of(path: Path, columns: Callable[[], dict[str, list[object]]]) -> Path:
    """Write a Parquet file of these columns."""
    import pyarrow
    from pyarrow.parquet import write_table

    write_table(pyarrow.table(columns()), path, compression="zstd", write_statistics=False)
    return path


def walk_with(count: int, note: list[object]) -> dict[str, list[object]]:
    """Return columns of so many rows, with notes which nobody asks for."""
    numbers: dict[str, list[object]] = {name: [0.01 * k for k in range(count)] for name in ("t", "acc_x", "acc_y")}
    return {**numbers, "acc_z": [9.8] * count, "note": note}


def compressed(path: Path, opened: Callable[..., object], start: str) -> Path:
    """Write a table or recording that begins well and unpacks to 50 MB of blank lines."""
    with opened(path, "wb") as file:  # type: ignore[attr-defined]
        file.write(start.encode())
        for _ in range(50):
            file.write(b"\n" * MEGABYTE)
    return path


def zipped(path: Path) -> Path:
    with (
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive,
        archive.open("a.csv", "w") as file,
    ):
        for _ in range(50):
            file.write(b"t,acc_x\n" * (MEGABYTE // 8))
    return path


def tagged(count: int) -> Iterable[str]:
    """Yield so many attributes."""
    return ("".join(f' a{k}="1"' for k in range(start, start + 1000)) for start in range(0, count, 1000))


LAUGHS = '<!DOCTYPE sst [<!ENTITY a "ha">' + "".join(
    f'<!ENTITY {chr(98 + k)} "{f"&{chr(97 + k)};" * 10}">' for k in range(9)
)
FAR = '<row r="{0}"><c r="XFD{0}"><v>1</v></c></row>'
HOSTILE: dict[str, Callable[[Path], Path]] = {
    "cell.xlsx": lambda path: workbook(path, sheet=[FAR.format(1048576)]),
    "cells.xlsx": lambda path: workbook(path, sheet=(FAR.format(k + 1) for k in range(60_000))),
    "number.xlsx": lambda path: workbook(path, sheet=['<row r="99999999999"><c r="A99999999999"><v>1</v></c></row>']),
    "blank.xlsx": lambda path: workbook(path, sheet=["<row/>" * (MEGABYTE // 6)] * 100),
    "attributes.xlsx": lambda path: workbook(path, sheet=[ROWS, "<row", *tagged(MEGABYTE), "/>"]),
    "remark.xlsx": lambda path: workbook(
        path, sheet=[ROWS, "<!--", *[f"{k:09d}\n" * 100_000 for k in range(19)], "-->"]
    ),
    "texts.xlsx": lambda path: workbook(path, texts=["<sst>", *["<si/>" * 100_000] * 30, "</sst>"]),
    "text.xlsx": lambda path: workbook(path, texts=["<sst><si><t>", *[f"{k:09d}\n" * 100_000 for k in range(19)]]),
    "laughs.xlsx": lambda path: workbook(path, texts=[LAUGHS, "]><sst><si><t>&j;</t></si></sst>"]),
    "lying.xlsx": lying,
    "rows.parquet": lambda path: parquet(path, 16, "t acc_x acc_y acc_z gyro_x gyro_y gyro_z"),
    "column.parquet": lambda path: parquet(path, 30, "t"),
    "columns.parquet": lambda path: parquet_of(path, lambda: {f"c{k}": [1.0] for k in range(10_001)}),
    "text.parquet": lambda path: parquet_of(path, lambda: {"t": ["x" * MEGABYTE] * 1200}),
    "note.parquet": lambda path: parquet_of(path, lambda: walk_with(1000, ["x" * MEGABYTE] * 1000)),
    "notes.parquet": lambda path: parquet_of(
        path, lambda: walk_with(300, [f"{k}" + "x" * MEGABYTE for k in range(300)])
    ),
    "rows.xlsx": lambda path: workbook(path, sheet=(f'<row r="{k + 1}"/>' for k in range(MEGABYTE))),
    "blanks.xlsx": lambda path: workbook(path, sheet=[ROWS, *["<row> </row>" * 1000] * 1000]),
    "walk.csv.gz": lambda path: compressed(path, gzip.open, "t,acc_x,acc_y,acc_z\n0,0,0,9.8\n"),
    "walk.jsonl.xz": lambda path: compressed(path, lzma.open, '{"format": "solepath-packets", "version": 1}\n'),
    "walk.zip": zipped,
}
"""How each hostile file is written, by its name."""
