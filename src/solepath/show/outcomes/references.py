"""Published values for comparison, each with its source: of healthy people, and changes that matter to patients.

Only numbers of the sources stand here. A mean, and an interval of a mean, say where the average of a group is, not
where most of its members are; the lower limit of normal is below nearly all of them. No column has both."""

from __future__ import annotations

from collections.abc import Sequence

from attrs import frozen

from ...types import ValueEnum


class Sex(ValueEnum):
    """The sex for which a study gives values."""

    FEMALE = "female"
    MALE = "male"


@frozen
class Person:
    """The person for whom reference values are looked up; a value that needs what is not known is not given."""

    age: float
    """Age of the person, years."""
    sex: Sex
    height: float | None = None
    """Height of the person, m."""
    weight: float | None = None
    """Body mass of the person, kg."""


@frozen(kw_only=True)
class Reference:
    """A published value for people like this one, in the unit of the outcome: a prediction, or the mean of a group."""

    value: float
    lower_limit: float | None = None
    """Lower limit of normal of a prediction; None of a mean."""
    interval: tuple[float, float] | None = None
    """95 % confidence interval of a mean; None when the source gives none."""
    words: str
    """Short description of the value, such as "mean of healthy women aged 70 to 79"."""
    source: str
    """Publication of the value."""

    @property
    def predicted(self) -> bool:
        """True if the value was predicted for this person, False if it is the mean of a group."""
        return self.lower_limit is not None


@frozen(kw_only=True)
class SmallestChange:
    """The smallest change of an outcome that matters, in its unit."""

    value: float
    words: str
    """Whose change it is, and by what it was found."""
    source: str

    def reached_by(self, change: float) -> bool:
        """Return whether a change, in the same unit, is as large, up or down."""
        return abs(change) >= self.value


SIX_MINUTE_CHANGE = SmallestChange(
    value=30.0,
    words="adults with chronic lung disease, by what they notice",
    source="Holland et al. 2014, Eur. Respir. J. 44",
)
UP_AND_GO_CHANGE = SmallestChange(
    value=3.5,
    words="people with Parkinson's disease, beyond the error of two tests",
    source="Huang et al. 2011, Phys. Ther. 91",
)
WALKING_SPEED_CHANGE = SmallestChange(
    value=0.1, words="older people, a substantial change", source="Perera et al. 2006, J. Am. Geriatr. Soc. 54"
)


WALKING_SPEEDS = {
    Sex.MALE: ((20, 1.36), (30, 1.43), (40, 1.43), (50, 1.43), (60, 1.34), (70, 1.26), (80, 0.97)),
    Sex.FEMALE: ((20, 1.34), (30, 1.34), (40, 1.39), (50, 1.31), (60, 1.24), (70, 1.13), (80, 0.94)),
}
"""First age of each group, years, and mean speed at a usual pace, m/s; the last group goes up to 99 years."""
SPEED_SOURCE = "Bohannon and Andrews 2011, Physiotherapy 97"
UP_AND_GO_TIMES = ((60, 8.1, 7.1, 9.0), (70, 9.2, 8.2, 10.2), (80, 11.3, 10.0, 12.7))
"""First age of each group, years, mean, and 95 % confidence interval of the mean, s; the last group up to 99 years."""
UP_AND_GO_SOURCE = "Bohannon 2006, J. Geriatr. Phys. Ther. 29"
SIX_MINUTE_SOURCE = "Enright and Sherrill 1998, Am. J. Respir. Crit. Care Med. 158"
SIX_MINUTE_AGES = (40.0, 80.0)
"""Youngest and oldest age of the people of Enright and Sherrill 1998, years."""
LOWER_LIMITS = {Sex.MALE: 153.0, Sex.FEMALE: 139.0}
"""Distance by which the lower limit of normal is below the predicted six-minute distance, m (same source)."""
OLDEST = 100.0
"""Age at which the oldest groups end, years."""


def _of_group(groups: Sequence[Sequence[float]], age: float, people: str, words: str, source: str) -> Reference | None:
    """Return the values of the group of an age; None outside all groups."""
    known = [group for group in groups if group[0] <= age < OLDEST]
    if not known:
        return None
    first, value, *ends = known[-1]
    interval = (ends[0], ends[1]) if ends else None
    group = f"mean of healthy {people} aged {first:.0f} to {99 if first >= 80 else first + 9:.0f}"
    return Reference(value=value, interval=interval, words=f"{group}{words}", source=source)


def walking_speed_reference(person: Person) -> Reference | None:
    """Return the mean usual walking speed, m/s, of people of this age and sex; None below 20 and above 99 years."""
    people = "men" if person.sex is Sex.MALE else "women"
    return _of_group(WALKING_SPEEDS[person.sex], person.age, people, ", at their usual pace", SPEED_SOURCE)


def up_and_go_reference(person: Person) -> Reference | None:
    """Return the mean timed up and go, s, of people of this age; None below 60 and above 99 years.

    The source calls a person slower than the upper end of the interval worse than average."""
    return _of_group(UP_AND_GO_TIMES, person.age, "people", "", UP_AND_GO_SOURCE)


def six_minute_reference(person: Person) -> Reference | None:
    """Return the six-minute distance, m, that the equations of Enright and Sherrill 1998 predict, and its lower limit.

    They need height and weight, and are of people aged 40 to 80; None otherwise."""
    if person.height is None or person.weight is None or not SIX_MINUTE_AGES[0] <= person.age <= SIX_MINUTE_AGES[1]:
        return None
    height = 100.0 * person.height
    if person.sex is Sex.MALE:
        value = 7.57 * height - 5.02 * person.age - 1.76 * person.weight - 309.0
    else:
        value = 2.11 * height - 2.29 * person.weight - 5.78 * person.age + 667.0
    words, lower_limit = "predicted from age, sex, height and weight", value - LOWER_LIMITS[person.sex]
    return Reference(value=value, lower_limit=lower_limit, words=words, source=SIX_MINUTE_SOURCE)
