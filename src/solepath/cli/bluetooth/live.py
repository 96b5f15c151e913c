"""`solepath live` and `solepath record`: receive packets from devices while they are worn."""

from __future__ import annotations

from argparse import Namespace
from functools import partial
from pathlib import Path

from ..common.files import RECORDING, OutputFile, add_force, check_outputs, files_of_track
from ..common.inputs import (
    add_calibration,
    add_floorplan,
    add_heading,
    calibration_of,
    floorplan_of,
    recipe_option,
    recipes_of,
)
from ..common.parser import command, option
from ..common.view import add_no_browser, page_address_of, view_option
from .devices import add_devices, need_bleak
from .live_streams import need_lsl, stream_names_of


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


add_live = command(
    "live",
    "Connect to sensors on the feet and show gait, track and links as they are worn. Without "
    "--left and --right it takes two insoles when any are in range, which know their feet.",
    "solepath live --left F0:5E:00:00:00:01 --right F0:5E:00:00:00:02 --record walk.jsonl",
    add_devices,
    view_option("show it"),
    add_no_browser,
    recipe_option(),
    add_heading,
    add_calibration,
    add_floorplan,
    option("--record", metavar="FILE", type=Path, help="write the packets as a recording too"),
    option(
        "--out",
        metavar="DIR",
        type=Path,
        help="write events.jsonl, track.csv, strides.csv, gait_cycles.csv and run.json into this directory, with a "
        "floor plan places.csv too",
    ),
    option(
        "--lsl",
        metavar="NAME",
        nargs="?",
        const="solepath",
        help="publish samples, poses and events as streams of the lab streaming layer, whose names start with NAME "
        "(default: solepath)",
    ),
    option(
        "--channels",
        metavar="NAMES",
        help="what the channels of streams of LSL are (--left lsl:NAME), in order, where they do not say it: "
        "acc_x,acc_y,acc_z,gyro_x,... and - for one that is not used",
    ),
    option(
        "--units", metavar="ACC,GYRO", help="the units of acc and gyro of such streams, where they do not say: g,deg/s"
    ),
    add_force,
    run=run,
)
add_record = command(
    "record",
    "Connect to sensors and write every packet as it arrives; a file for `solepath track`. Whatever "
    "happens to this program, what came until 200 ms before can be read.",
    "solepath record --out walk.jsonl --duration 120",
    add_devices,
    option("--out", metavar="FILE", dest="record", type=Path, required=True, help="the recording"),
    add_force,
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
