"""Saves a scene as plain data for JSON, and restores it: what a page showed goes on in another process."""

from __future__ import annotations

from typing import Any

from ....floorplan.plan import FloorPlan
from ....recipes import part_class
from ....saving.codec import Json, load, save
from .plan_drawing import draw_plan
from .scene import Scene


def save_scene(scene: Scene) -> Json:
    """Return a scene as plain data, without its floor plan and its playback.

    SnapshotError is raised for a scene in which nothing has happened: its time is not known yet."""
    return save(scene)


def restore_scene(saved: Any, plan: FloorPlan | None = None) -> Scene:
    """Return the scene that `save_scene` saved, with its floor plan; raise SnapshotError when it does not fit."""
    scene = load(Scene, saved, part_class)
    scene.plan = draw_plan(plan)
    return scene
