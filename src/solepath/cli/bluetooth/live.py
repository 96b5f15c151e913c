"""`solepath live` and `solepath record`: receive packets from devices while they are worn."""

from __future__ import annotations

from argparse import Namespace
from functools import partial
from pathlib import Path
from typing import Any

from ..common.files import RECORDING, OutputFile, add_force, check_outputs, files_of_track
from ..common.inputs import add_calibration, add_floorplan, add_recipe, calibration_of, floorplan_of, recipes_of
from ..common.parser import add_command
from ..common.view import add_view, page_address_of
from .devices import add_devices, need_bleak
from .live_streams import need_lsl, stream_names_of


def add_to(commands: Any) -> None:
    """Add both commands to the parser."""
    live = add_command(
        commands,
        "live",
        "listen to sensors and show what they say",
        "Connect to sensors on the feet and show gait, track and links as they are worn. Without "
        "--left and --right it takes two insoles when any are in range, which know their feet.",
        "solepath live --left F0:5E:00:00:00:01 --right F0:5E:00:00:00:02 --record walk.jsonl",
        run=run,
    )
    add_devices(live)
    add_view(live, live, "show it")
    add_recipe(live)
    add_calibration(live)
    add_floorplan(live)
    live.add_argument("--record", metavar="FILE", type=Path, help="write the packets as a recording too")
    live.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        help="write events.jsonl, track.csv, strides.csv, gait_cycles.csv and run.json into this directory, with a "
        "floor plan places.csv too",
    )
    live.add_argument(
        "--lsl",
        metavar="NAME",
        nargs="?",
        const="solepath",
        help="publish samples, poses and events as streams of the lab streaming layer, whose names start with NAME "
        "(default: solepath)",
    )
    live.add_argument(
        "--channels",
        metavar="NAMES",
        help="what the channels of streams of LSL are (--left lsl:NAME), in order, where they do not say it: "
        "acc_x,acc_y,acc_z,gyro_x,... and - for one that is not used",
    )
    live.add_argument(
        "--units", metavar="ACC,GYRO", help="the units of acc and gyro of such streams, where they do not say: g,deg/s"
    )
    add_force(live)

    record = add_command(
        commands,
        "record",
        "write what sensors send into a file",
        "Connect to sensors and write every packet as it arrives; a file for `solepath track`. Whatever "
        "happens to this program, what came until 200 ms before can be read.",
        "solepath record --out walk.jsonl --duration 120",
    )
    add_devices(record)
    record.add_argument("--out", metavar="FILE", dest="record", type=Path, required=True, help="the recording")
    add_force(record)
    record.set_defaults(
        run=run,
        recipe="default",
        heading=None,
        calibration=None,
        out=None,
        floorplan=None,
        start=None,
        view=None,
        lsl=None,
    )


def run(options: Namespace) -> int:
    """Receive from the devices; return the exit status."""
    (recipe,) = recipes_of(options)
    recording = [] if options.record is None else [OutputFile(options.record, RECORDING)]
    check_outputs(options, [*recording, *files_of_track(options.out, places=options.floorplan is not None)])
    calibration = calibration_of(options)
    address = page_address_of(options)
    plan, start = floorplan_of(options)
    if stream_names_of(options):
        need_lsl("streams of LSL need")
    else:
        need_bleak()
        if options.lsl is not None:
            need_lsl("--lsl needs")
    from ..common.loop import run_to_end
    from .live_run import listen

    return run_to_end(partial(listen, options, recipe, calibration, plan, start, address))
