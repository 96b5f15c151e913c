"""`solepath-lab reproduce --resume` and `--seeds`: walks that are done are not walked again, and seeds are pooled."""

import attrs
import pytest
from commands import run_failing

from solepath_lab.command import main as lab
from solepath_lab.reproduce.done_jobs import DoneJobs, DoneJobsError
from solepath_lab.reproduce.runner import Runner
from solepath_lab.reproduce.seeds import reproduce_seeds
from solepath_lab.reproduce.tables import Claim, Reproduction, Statistics, WalkResults, as_json, gathered
from solepath_lab.tables.comparison import comparison_with_paper


@attrs.frozen
class Walked:
    """A result with its length, m."""

    length: float


WALKED: list[int] = []
"""Numbers that were walked in this process."""


def walk_number(number: int) -> Walked:
    WALKED.append(number)
    return Walked(number / 3.0)


def runner_of(path, lines=None):
    done_jobs = DoneJobs(path, "kupt-dfpc")
    done_jobs.open_file()
    return Runner(report=[].append if lines is None else lines.append, done_jobs=done_jobs)


def run_numbers(path, numbers, lines=None):
    WALKED.clear()
    return runner_of(path, lines).run(walk_number, numbers, lambda one: f"{one.length:.1f} m")


def test_an_experiment_goes_on_where_it_stopped(tmp_path):
    file, lines = tmp_path / "walks.jsonl", []
    assert run_numbers(file, [1, 2]) == [Walked(1 / 3), Walked(2 / 3)] and WALKED == [1, 2]
    assert run_numbers(file, [3, 2, 1], lines) == [Walked(1.0), Walked(2 / 3), Walked(1 / 3)] and WALKED == [3]
    assert lines == ["2 of 3 were already done", "3 of 3: 1.0 m"]


def test_a_walk_that_was_being_written_is_walked_again(tmp_path):
    file = tmp_path / "walks.jsonl"
    run_numbers(file, [1, 2, 3])
    whole = file.read_bytes()
    for cut in range(0, len(whole), 31):
        file.write_bytes(whole[:cut])
        n_done = max(0, whole[:cut].count(b"\n") - 1)
        assert run_numbers(file, [1, 2, 3]) == [Walked(k / 3) for k in (1, 2, 3)]
        assert [1, 2, 3][n_done:] == WALKED
        assert file.read_bytes() == whole


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"a letter\n", "has no results of walks"),
        (b'{"experiment": "shoe-sensing", "source": 1}\n', "has walks of 'shoe-sensing', not of 'kupt-dfpc'"),
        (b'{"experiment": "kupt-dfpc", "source": 1}\n', "other code of solepath"),
    ],
)
def test_a_file_of_something_else_stays_as_it_is(tmp_path, content, words):
    file = tmp_path / "walks.jsonl"
    file.write_bytes(content)
    with pytest.raises(DoneJobsError, match=words):
        runner_of(file)
    assert file.read_bytes() == content
    line = run_failing("reproduce", "kupt-dfpc", "--walks", 1, "--seed", 1, "--resume", file, program=lab)
    assert line.startswith(f"solepath: {file}: ") and words in line and line.count("\n") == 1


def of_seed(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    runner.report(f"{runner.title}walked")
    blocks = {
        "": [WalkResults({"ZUPT-L": (10.0 * seed + 2.0 * k,), "(off) ZUPT-L": (-1.0 - seed,)}) for k in (0, 1)],
        "short: ": [WalkResults({"KUPT-L": (20.0,)})],
    }
    for one in blocks[""]:
        one.values["(off) KUPT-L"] = (0.5, -0.7)
    return Reproduction("kupt-dfpc", f"{walks} walks", "m", gathered(blocks))


def test_several_seeds_are_one_table_and_one_list_of_claims():
    lines: list[str] = []
    pooled = reproduce_seeds(of_seed, 2, (1, 2), Runner(report=lines.append))
    assert lines == ["seed 1, walked", "seed 2, walked"]
    # a row for each name without a bracket, behind the title of its block; the paper's figures stand beside it
    rows = {row.name: row for row in pooled.rows}
    assert list(rows) == ["ZUPT-L", "short: KUPT-L"] and rows["ZUPT-L"].values == (10.0, 12.0, 20.0, 22.0)
    assert rows["ZUPT-L"].paper.mean == 20.97 and rows["short: KUPT-L"].paper == Statistics()
    # 2 - 0.6 for both walks of seed 1, 3 - 0.6 for those of seed 2; claims without walks are left out
    (claim,) = pooled.claims
    assert claim.margins == pytest.approx((1.4, 1.4, 2.4, 2.4))
    assert as_json(pooled)["claims"] == {"KUPT errs less than ZUPT": "holds"}
    text = comparison_with_paper(pooled)
    assert text.startswith("kupt-dfpc: ours is emulated (2 walks; seed 1, 2)")
    assert "\nKUPT errs less than ZUPT: by 1.9 m (95 % interval " in text


@pytest.mark.parametrize(
    ("margins", "half_width", "verdict"),
    [
        ((1.0, 2.0, 3.0, 4.0, 5.0), 2.776 * 2.5**0.5 / 5**0.5, "holds"),
        ((-1.0, -1.2, -1.0), None, "fails"),
        ((1.0, -1.0, 0.5, -0.4, 0.0, 0.1), 2.571 * 0.6947 / 6**0.5, "is open"),
        ((1.0,), None, "is open"),
    ],
)
def test_a_claim_holds_if_the_interval_of_its_mean_margin_is_above_zero(margins, half_width, verdict):
    # half the width is the 97.5 % point of Student's t (tables) times the standard error
    of_walks = Claim("nearer", margins)
    low, high = of_walks.interval
    assert half_width is None or 0.5 * (high - low) == pytest.approx(half_width, rel=2e-3)
    assert of_walks.verdict == verdict and str(of_walks).endswith(f"n = {len(margins)}), so it {verdict}.")


def test_walks_that_go_on_need_the_seed_with_which_they_began(tmp_path):
    line = run_failing("reproduce", "kupt-dfpc", "--resume", tmp_path / "walks.jsonl", program=lab)
    assert line == "solepath: --resume needs the --seed of the walks with which it goes on\n"
