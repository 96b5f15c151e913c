"""Makes the texts and tables of the runs of `solepath fleet-demo`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from attrs import asdict
from attrs.filters import exclude

from ..show.tables.table import number, percent, table

if TYPE_CHECKING:
    from ..fleet.demo.kills import Cost, Outcome
    from ..fleet.demo.stage import DemoStage, Engine


def kill_lines(engine: Engine, run: int, outcome: Outcome) -> list[str]:
    """Return a line for each kill of a run; the last one ends with the result of the run."""
    lines = [f"killed run {run}: {_kill_text(engine, cost)}" for cost in outcome.costs]
    if outcome.differences:
        lines[-1] += "; other events"
    elif any(cost.had_effect for cost in outcome.costs):
        lines[-1] += "; the same events"
    else:
        lines[-1] += "; nothing was lost that had to come back"
    return lines


def recovery_line(outcomes: list[Outcome]) -> str:
    """Return a sentence on how many kills had an effect from which the engine had to recover."""
    costs = [cost for outcome in outcomes for cost in outcome.costs]
    if not costs:
        return "nothing was killed"
    replayed, reopened = sum(bool(cost.replayed) for cost in costs), sum(cost.reopened > 0 for cost in costs)
    kills = "1 kill" if len(costs) == 1 else f"{len(costs)} kills"
    sentence = f"of {kills} {replayed} had something read again, and {reopened} had wearers go on from states"
    if not reopened:
        return f"{sentence}: so no state was tried. Let them walk longer (--seconds) or kill more often (--kills)."
    return sentence


def _kill_text(engine: Engine, cost: Cost) -> str:
    processes = "all processes" if cost.kill.which is None else f"process {cost.kill.which}"
    progress = f"with {100 * cost.reached:.0f} % read" if cost.started else "while it started"
    if cost.replayed is None or cost.down is None:
        return f"{processes}, {progress}; the next kill came before all of it read on"
    replayed = cost.replayed * engine.seconds
    recovery = f"reads on {cost.down:.1f} s later, {replayed:.1f} s replayed"
    return f"{processes}, {progress}; {recovery}, {cost.reopened} went on from their states"


def result_table(stage: DemoStage) -> str:
    """Return the table of the figures of all runs, with a dash for a missing figure."""
    values = figures(stage)
    engine, sessions, kills = values["engine"], values["sessions"], values["kills"]
    costs = [kill for kill in kills if kill["replayed"] is not None]
    equal = sum(run["equal"] for run in values["runs"])
    replayed_kills, reopened_kills = (sum(bool(kill[key]) for kill in kills) for key in ("replayed", "reopened"))
    replayed, down = ([kill[key] for kill in costs] for key in ("replayed", "down"))
    rows = [
        ["wearers", str(values["wearers"])],
        ["samples", str(values["samples"])],
        [f"samples/s through the engine, {values['processes']} processes", number(engine["rate"], 0)],
        ["samples/s by as many processes of sessions without an engine", number(sessions["rate"], 0)],
        ["the one by the other, %", percent(values["ratio"], 0)],
        ["s between two snapshots", number(engine["every"], 2)],
        ["snapshots before the end", str(engine["snapshots"])],
        ["memory in all, MB", number(_scaled(engine["memory"], 1e-6), 0)],
        ["memory a wearer, kB", number(_scaled(engine["wearer"], 1e-3), 0)],
        ["state a wearer, nothing held, kB: mean", number(sessions["state"] / 1e3, 1)],
        ["state a wearer, nothing held, kB: largest", number(sessions["largest"] / 1e3, 1)],
        ["state with rows held behind a missing one, kB: largest", number(_scaled(sessions["held"], 1e-3), 1)],
        ["state taken in, us: median", number(sessions["snapshot"] * 1e6, 0)],
        ["events", str(engine["events"])],
        ["files", str(engine["files"])],
        ["kills", str(len(kills))],
        ["of them with something read again", str(replayed_kills)],
        ["of them with wearers who went on from states", str(reopened_kills)],
        ["s replayed after a kill: mean", number(_mean(replayed), 1)],
        ["s replayed after a kill: most", number(max(replayed, default=None), 1)],
        ["s until it read on: mean", number(_mean(down), 1)],
        ["killed runs", str(len(values["runs"]))],
        ["of them with the same events", str(equal)],
    ]
    return table(["a fleet on bytewax", ""], rows)


def figures(stage: DemoStage) -> dict[str, Any]:
    """Return the figures of all runs for programs, in s, bytes and samples/s."""
    engine, sessions, plan = stage.engine, stage.sessions, stage.plan
    if engine is None or sessions is None:
        raise ValueError("nothing has run yet")
    samples = sum(stage.samples)
    rate = samples / engine.seconds
    kills = [
        {
            "run": number,
            "share": cost.kill.share,
            "after": cost.kill.after,
            "process": cost.kill.which,
            "started": cost.started,
            "read": cost.reached,
            "replayed": None if cost.replayed is None else cost.replayed * engine.seconds,
            "down": cost.down,
            "reopened": cost.reopened,
        }
        for number, outcome in enumerate(stage.outcomes, 1)
        for cost in outcome.costs
    ]
    return {
        "wearers": plan.wearers,
        "seconds": plan.seconds,
        "seed": plan.seed,
        "recipe": plan.recipe,
        "processes": plan.parts,
        "samples": samples,
        "engine": {
            "rate": rate,
            "seconds": engine.seconds,
            "whole": engine.total_duration,
            "every": engine.snapshot_interval,
            "snapshots": engine.snapshots,
            "cpu": engine.cpu,
            "memory": engine.full,
            "wearer": stage.memory,
            "events": engine.events,
            "files": engine.files,
        },
        "sessions": asdict(sessions, filter=exclude("cpu")),
        "ratio": rate / sessions.rate,
        "kills": kills,
        "runs": [{"equal": not outcome.differences, "differences": outcome.differences} for outcome in stage.outcomes],
    }


def _scaled(value: float | None, scale: float) -> float | None:
    return None if value is None else value * scale


def _mean(values: list[float]) -> float | None:
    return sum(values) / len(values) if values else None
