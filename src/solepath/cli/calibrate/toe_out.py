"""`solepath calibrate toe-out`: how far feet point beside their way, from a straight walk, recorded or walked now."""

from __future__ import annotations

from argparse import Namespace
from math import degrees

from ...calibration import Calibration
from ...show.tables.table import number, table
from ..common.failure import Failure, parse_positive
from ..common.files import RECORDING
from ..common.own_devices import drivers_of
from ..common.parser import command, option
from ..common.tables import source_named, table_options
from .live import live_options, measure_live


def _toe_out(options: Namespace, known: Calibration) -> tuple[Calibration, list[str]]:
    from ...papers.footstep_tracker.toe_out import ERRORS, ToeOut, printed_angle, toe_out, toe_out_calibration

    if options.live and options.driver_files:
        raise Failure("--driver is for a recording here: make it with `solepath record`, and give it without --live")
    measure_live(options, RECORDING, "calibrate toe-out --live shows a person how to walk")
    distance = options.distance
    feet = toe_out(source_named(options, drivers_of(options)), distance)

    def by_length(one: ToeOut) -> str:
        printed = printed_angle(one.along, distance)
        return "none" if printed is None else " +- ".join([number(degrees(angle)) for angle in printed])

    header = ["foot", "strides", "along the foot m", "toe-out degrees"] + ["by the length"] * (distance is not None)
    rows = []
    for one in feet:
        angle = f"{number(degrees(one.angle))} +- {number(degrees(one.sigma))}"
        row = [one.foot.value, str(one.strides), number(one.along, 2), angle]
        rows.append(row if distance is None else [*row, by_length(one)])
    lines = [table(header, rows)]
    unknown = [one.foot.value for one in feet if not one.is_known]
    if unknown:
        lines.append(
            f"{' and '.join(unknown)}: the angle is less than {ERRORS:g} of its errors: nothing is learnt of it"
        )
    if len(unknown) == len(feet):
        raise Failure("\n".join([*lines, "nothing is learnt"]))
    return toe_out_calibration(feet), lines


add_toe_out = command(
    "toe-out",
    "how far feet point beside their way, from a straight walk",
    "From a straight walk: how far each foot points outwards of its way, which the recipe "
    "footstep-tracker takes into account. With the length of the walk, the paper's angle is shown too. With "
    "--live, the command says how to walk, shows strides and angles as they come, and writes the recording.",
    "solepath calibrate toe-out corridor.jsonl --distance 20 --out me.json",
    table_options("RECORDING"),
    option("--distance", metavar="M", type=parse_positive, help="length of the walk, m"),
    live_options("walk now, with the sensors in the shoes, and write RECORDING", "what to do, strides and angles"),
    learn=_toe_out,
)
