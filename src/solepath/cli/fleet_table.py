"""Makes the texts and tables of the runs of `solepath fleet-demo`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from attrs import asdict

from ..show.tables.table import number, percent, table

if TYPE_CHECKING:
    from ..fleet.demo.run import DemoStage, Kill


def kill_line(stage: DemoStage, run: int, kill: Kill, down: float) -> str:
    """Return a line about a kill."""
    place = f"after {kill.batches} of {len(stage.times)} batches"
    rest = ", in the middle of the next, which runs again" if kill.is_in_batch else ""
    return f"kill {run}: {place}{rest}; the next batch ends {down:.1f} s later"


def result_table(stage: DemoStage) -> str:
    """Return the table of the figures of all runs, with a dash for a missing figure."""
    values = figures(stage)
    engine, kills = values["engine"], values["kills"]
    downs = [kill["down"] for kill in kills]
    rows = [
        ["wearers", str(values["wearers"])],
        ["samples", str(values["samples"])],
        [f"samples/s through Spark, {values['processes']} processes", number(engine["rate"], 0)],
        ["samples/s by one process of sessions without an engine", number(values["sessions"]["rate"], 0)],
        ["the one by the other, %", percent(values["ratio"], 0)],
        ["batches", str(engine["batches"])],
        ["s a batch", number(engine["batch"], 2)],
        ["events", str(engine["events"])],
        ["kills", str(len(kills))],
        ["of them in the middle of a batch", str(sum(kill["is_in_batch"] for kill in kills))],
        ["s until the next batch was done: mean", number(sum(downs) / len(downs) if downs else None, 1)],
        ["s until the next batch was done: most", number(max(downs, default=None), 1)],
    ]
    return table(["a fleet on Spark", ""], rows)


def figures(stage: DemoStage) -> dict[str, Any]:
    """Return the figures of all runs for programs, in s, bytes and samples/s."""
    plan = stage.plan
    rate = stage.samples / stage.session_seconds
    return {
        "wearers": plan.wearers,
        "seconds": plan.seconds,
        "seed": plan.seed,
        "recipe": plan.recipe,
        "processes": plan.processes,
        "samples": stage.samples,
        "engine": {
            "rate": stage.rate,
            "whole": stage.whole,
            "batches": len(stage.times),
            "batch": stage.batch,
            "events": len(stage.events),
        },
        "sessions": {"seconds": stage.session_seconds, "rate": rate},
        "ratio": stage.rate / rate,
        "kills": [{**asdict(kill), "down": down} for kill, down in stage.kills],
    }
