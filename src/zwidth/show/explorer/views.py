"""The pictures of a page: which there are, when each is drawn, and who computes what takes longer.

What is cheap follows every move; the rest is computed when a slider is let go, for the picture that is open.
"""

from __future__ import annotations

from typing import Any

from zwidth.model.environment import Wall
from zwidth.show.explorer import computing, criterion, laws, motion, plane, region
from zwidth.show.explorer.arms_view import Arms
from zwidth.show.explorer.form import words
from zwidth.show.explorer.play_view import play_view
from zwidth.show.explorer.touch_view import Touches
from zwidth.show.explorer.verdict_card import WAITING
from zwidth.show.explorer.view import Asked, View, said, wide
from zwidth.show.explorer.working import Answer
from zwidth.showing import element, join


def views_of(page: Asked) -> list[View]:
    """All of them, in the order of their tabs."""
    touches = Touches(page)
    return [
        _cheap(page, "criterion", criterion.NAME, criterion.CriterionPicture()),
        _cheap(page, "plane", plane.NAME, plane.PlanePicture()),
        _region(page),
        touches.view,
        touches.energy_view,
        _motion(page),
        _laws(page),
        Arms(page).view,
        play_view(page),
    ]


def _cheap(page: Asked, key: str, name: str, picture: Any) -> View:
    caption = words(element("p"))

    def moved() -> None:
        said(caption, picture.show(page.verdict))

    return View(key, name, [wide(picture.figure), caption], moved, lambda: None)


def _region(page: Asked) -> View:
    picture, caption = region.RegionPicture(), words(element("p"))

    def come(answer: Answer) -> None:
        wall = page.state.loop().environment
        if answer.value is None or not isinstance(wall, Wall):
            picture.clear()
            said(caption, answer.message)
            return
        here = abs(computing.middle(wall.damping)), computing.middle(wall.stiffness)
        said(caption, picture.show(answer.value, *here, page.state.motion))

    def released() -> None:
        said(caption, WAITING)
        page.compute("region", computing.region_of, come)

    return View("region", region.NAME, [wide(picture.figure), caption], lambda: None, released)


def _motion(page: Asked) -> View:
    pictures, caption = motion.MotionPictures(), words(element("p"))

    def come(answer: Answer) -> None:
        if answer.value is None:
            pictures.clear()
            said(caption, answer.message)
            return
        said(caption, pictures.show(answer.value, page.state.motion))

    def released() -> None:
        said(caption, WAITING)
        page.compute("motion", computing.moved, come)

    figures = [wide(one) for one in (pictures.position, pictures.force, pictures.energy)]
    return View("motion", motion.NAME, [caption, pictures.player, *figures], lambda: None, released)


def _laws(page: Asked) -> View:
    table = words(element("p"))

    def come(answer: Answer) -> None:
        if answer.value is None:
            said(table, answer.message)
        else:
            moves = page.state.motion
            hint = join() if page.state.laws else element("p", laws.NONE)
            table.html = f"{laws.compared_table(answer.value, moves)}{hint}"

    def released() -> None:
        said(table, WAITING)
        page.compute("laws", computing.compared, come)

    return View("laws", laws.NAME, [table], lambda: None, released)
