# SPDX-License-Identifier: Apache-2.0
"""takt: simulates, bounds and verifies TSN networks whose nodes run distributed OPC UA Programs.

    import takt
    arm = takt.load("scenarios/robot-arm.json")
    r = arm.run()
    print(r.verdict, r.digest, r.programs["trajectory"].reactions[0].duration_ps)
    r.timeline()                      # in a notebook: a picture
    r.frames().to_pandas()            # what became of each frame, if run(frames=True)
    takt.study("study.json").run().heatmap("slaves", "cycle", "start")

Names of results are those of result.json (docs/reference/result.md). Times are whole picoseconds. The same scenario and seed give the same digest here and by `takt run`.
"""
import json as _json
import os as _os
import warnings as _warnings

try:
    from . import _takt
except ImportError as _error:
    raise ImportError(
        "takt: the compiled part of the module, _takt, is not there for this Python. It is built with pybind11-dev and "
        "python3-dev for the Python of the system: tools/setup more, then tools/run. Or install python3-takt"
    ) from _error
from ._takt import Mistake
from .records import Record

__all__ = ["Figure", "Frames", "Mistake", "Plan", "Record", "Result", "Scenario", "Schedule", "Table", "explore", "load", "loads", "read_store", "schedule", "study"]
__version__ = _takt.version
behaviour = _takt.behaviour   # figures of one scenario and seed can be compared where this number is the same


def load(path, **overrides):
    """The scenario of a file. `overrides` are as in Scenario.override. Mistakes are a takt.Mistake with all of them."""
    path = _os.fspath(path)
    return Scenario(_takt.load_file(path, []), lambda options: _takt.load_file(path, options), lambda options, how, progress: _takt.schedule_file(path, options, how, progress)).override(**overrides)


def loads(text, name="scenario.json", **overrides):
    """The scenario of a text, or of what json.dumps makes one of. `name` stands in diagnostics; traces are sought beside it."""
    if not isinstance(text, str):
        text = _json.dumps(text)
    return Scenario(_takt.load_text(text, name, []), lambda options: _takt.load_text(text, name, options), lambda options, how, progress: _takt.schedule_text(text, name, options, how, progress)).override(**overrides)


def study(path):
    """The study of a file, read and expanded; nothing has run."""
    return Plan(_takt.load_plan(_os.fspath(path)))


def read_store(path):
    """What a study has left behind (takt study --out STORE). Warns if a takt with another number of behaviour made it."""
    core = _takt.read_store(_os.fspath(path))
    if difference := core.difference(_os.fspath(path)):
        _warnings.warn(f"{difference}: its figures are those of then", stacklevel=2)
    return Table(core)


def _how_to_schedule(*, routes="search", objective="feasible", limit="10s", seed=1, jobs=None, entries=1_000_000, gates=False, progress=None):
    return _takt.HowToSchedule(routes, objective, limit, seed, jobs or 0, entries, gates)


def schedule(*paths, routes="search", objective="feasible", limit="10s", seed=1, jobs=None, entries=1_000_000, gates=False, progress=None):
    """Routes, phases and gate lists that are found, or why there are none, as `takt schedule` does: of the file of a scenario with automatic gates, or of instances of scheduling problems
    (network and streams one after the other where they are two files).

    A Schedule, or a list of them if the files hold several instances. Names are those of docs/reference/schedule.md, of a scenario of schedule-scenario.md. What is found by `limit`, a real time, may depend on the machine; progress is its share.
    """
    how = _how_to_schedule(routes=routes, objective=objective, limit=limit, seed=seed, jobs=jobs, entries=entries, gates=gates)
    found = [Schedule(each) for each in _takt.schedule_files([_os.fspath(path) for path in paths], how, progress)]
    return found[0] if len(found) == 1 else found


def _explored(core, what):
    known = dict(slaves=None, variant=None, faults=(), fault_budget=1, calls=None, depth=None, budget=100_000_000, network="registers", subscription=None, beginnings="all", nested=False,
                 inner_slaves=None, joining=False, candidates=None, starts_again=False, signed=False, key_changes=None, symmetry=True, finish=True, progress=None)
    for name in what:
        if name not in known:
            raise TypeError(f"there is no argument {name!r}; there are {', '.join(known)}")
    asked = {**known, **what}
    asked["faults"] = [asked["faults"]] if isinstance(asked["faults"], str) else list(asked["faults"])
    found = [Record(_json.loads(page)) for page in _takt.explore(core, {name: value for name, value in asked.items() if name != "progress"}, asked["progress"])]
    return found[0] if len(found) == 1 else found


def explore(slaves, **what):
    """Every order of messages, calls and faults of a group of so many slaves, as `takt explore` does: verdicts of the properties and a shortest counter-example of each that is violated.

    Arguments are the options of the command: variant, faults (a list), fault_budget, calls, depth, budget (states), network, subscription, beginnings, nested, inner_slaves, joining, candidates, starts_again,
    signed, key_changes; symmetry=False and finish=False are --no-symmetry and --no-finish. Names of the result are those of docs/reference/explore.md; cpu_s is 0. `progress` gets the share of the states that
    are done of those found.
    """
    return _explored(None, {"slaves": slaves, **what})


class Figure:
    """A picture of takt's own charts, as SVG. Notebooks show it."""

    def __init__(self, svg):
        self.svg = svg

    def _repr_svg_(self):
        return self.svg

    def save(self, path):
        """Writes the picture as a file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.svg)


class _Figures(list):
    """Several pictures, one below the other."""

    def _repr_html_(self):
        return "".join(f"<div>{figure.svg}</div>" for figure in self)


class Scenario:
    """A scenario, checked and resolved. It does not change: override() gives another one."""

    def __init__(self, core, again, plan, options=()):
        self._core = core
        self._again = again
        self._plan = plan
        self._options = list(options)

    @property
    def name(self):
        """As the file says."""
        return self._core.name

    @property
    def warnings(self):
        """What `takt check` warns of, as text."""
        return self._core.warnings

    def override(self, changes=None, **more):
        """The scenario with other values: override({"programs.0.cycle": "1ms"}, seed=7, duration="2s"), as --set, --seed and --duration."""
        if not changes and not more:
            return self
        options = list(self._options)
        for pointer, value in {**(changes or {}), **more}.items():
            pointer = pointer if pointer.startswith("/") or "." in pointer else "/" + pointer
            options.append(f"{pointer}={value if isinstance(value, str) else _json.dumps(value)}")
        return Scenario(self._again(options), self._again, self._plan, options)

    def to_dict(self):
        """The resolved scenario, with all defaults."""
        return _json.loads(self._core.to_json())

    def check(self):
        """What `takt check` prints."""
        return self._core.check()

    def run(self, *, frames=False, progress=None):
        """Simulates and judges. `frames` keeps what becomes of each frame; `progress` is called with a share from 0 to 1. Ctrl-C ends it."""
        return Result(_takt.run(self._core, frames, progress))

    def bound(self, *, clock_error="1us"):
        """How late frames and reactions can be at most; names as in docs/reference/bound.md."""
        return Record(_json.loads(_takt.bound(self._core, clock_error)))

    def verify(self, *, seeds=4, jobs=1, budget=60.0, progress=None):
        """Proves or refutes each requirement; names as in docs/reference/verify.md. `budget` is in millions of events."""
        return Record(_json.loads(_takt.verify(self._core, seeds, jobs, budget, progress)))

    def explain(self, stream=None, *, frame=None, lost=False, progress=None):
        """Why a frame took so long: the slowest of the stream (of any without one), number `frame`, or the first that was lost; names as in docs/reference/explain.md."""
        return Record(_json.loads(_takt.explain(self._core, stream, frame, lost, progress)))

    def schedule(self, **how):
        """Offsets, paths and gate lists for the scenario as it was written, or why there are none: see takt.schedule."""
        return Schedule(self._plan(list(self._options), _how_to_schedule(**how), how.get("progress")))

    def explore(self, **what):
        """Every order of messages, calls and faults in its Programs: see takt.explore. A list if there are several."""
        return _explored(self._core, what)

    def compare(self, other, *, pairs=10, seed=1, jobs=1, progress=None):
        """This one (a) and another (b) with the same seeds, and where they part; names as in docs/reference/compare.md."""
        return Record(_json.loads(_takt.compare(self._core, other._core, pairs, seed, jobs, progress)))

    def __repr__(self):
        return f"<takt.Scenario {self.name}>"


class Schedule(Record):
    """What `takt schedule --format json` says, and what was found."""

    __slots__ = ("_found", "_proof")

    def __init__(self, answer):
        report, found, proof = answer
        super().__init__(_json.loads(report))
        object.__setattr__(self, "_found", found)
        object.__setattr__(self, "_proof", proof)

    @property
    def scenario(self):
        """Of a scenario that was scheduled: the same with offsets, paths and gate lists. None otherwise."""
        return loads(self._found) if self._found and not self._is_solution() else None

    @property
    def solution(self):
        """Of an instance that was scheduled: starts, routes and gates as a dictionary (schedule-solution-1). None otherwise."""
        return _json.loads(self._found) if self._found and self._is_solution() else None

    @property
    def certificate(self):
        """Why there is no schedule, for a checker; None if nothing was proved."""
        return _json.loads(self._proof) if self._proof else None

    def _is_solution(self):
        return _json.loads(self._found).get("format") == "schedule-solution-1"

    def __repr__(self):
        return f"<takt.Schedule: {self.verdict} ({self.how})>"


class Result(Record):
    """What a run leaves behind: all names of result.json, and what is too much for that."""

    __slots__ = ("_core",)

    def __init__(self, core):
        super().__init__(_json.loads(core.to_json()))
        object.__setattr__(self, "_core", core)

    def report(self):
        """The page that `takt run` prints."""
        return self._core.report()

    def frames(self):
        """What became of each frame: NumPy columns. Only of run(frames=True)."""
        return Frames(self._core)

    def histogram(self, stream):
        """Latencies of a stream: arrays from_ps, to_ps (included) and count."""
        return Record(self._core.histogram(stream))

    def timeline(self):
        """Of each kind of reaction the slowest, as message-sequence charts."""
        return _Figures(map(Figure, self._core.timeline()))

    def page(self):
        """The page that `takt run --report` writes, as HTML."""
        return self._core.page()

    def __repr__(self):
        return f"<takt.Result {self.scenario}: {self.verdict}, digest {self.digest}>"


class Frames(Record):
    """Columns of all frames, read-only and where takt has put them. stream, node, event and reason are codes: names() says what they mean, -1 stands for none."""

    __slots__ = ("_names",)

    def __init__(self, core):
        super().__init__(core.frames())
        object.__setattr__(self, "_names", {"stream": core.streams, "node": core.nodes, "event": ["delivered", "dropped", "under way"], "reason": list(_takt.reasons)})

    def names(self, column):
        """What the codes of a column mean."""
        return self._names[column]

    def __len__(self):
        return len(self._members["stream"])

    def to_pandas(self):
        """A DataFrame; columns of names are categories. Times of what did not come are -1."""
        import pandas
        return pandas.DataFrame({name: pandas.Categorical.from_codes(values, self._names[name]) if name in self._names else values for name, values in self._members.items()}, copy=False)

    def __repr__(self):
        return f"<takt.Frames: {len(self)} rows of {', '.join(self._members)}>"


class Plan:
    """A study that can be run."""

    def __init__(self, core):
        self._core = core

    @property
    def name(self):
        """As the file says."""
        return self._core.name

    def __len__(self):
        """How many points there are."""
        return self._core.points

    def variant(self, point):
        """The levels of a point: "slaves = 3, cycle = 200us"."""
        return self._core.variant(point)

    def run_point(self, point):
        """One point, here and now: status, values of the measures, digest."""
        return Record(_takt.run_point(self._core, point))

    def run(self, store=None, *, resume=False, jobs=None, progress=None):
        """Runs all points (or with `resume` those that are missing) with worker processes, as `takt study` does, and reads the results. Without `store` they are kept in memory only."""
        import tempfile
        jobs = jobs or _os.cpu_count() or 1
        if store is not None:
            _takt.run_study(self._core, _os.fspath(store), resume, jobs, progress)
            return read_store(store)
        with tempfile.TemporaryDirectory(prefix="takt-study-") as folder:
            path = _os.path.join(folder, "study.sqlite")
            _takt.run_study(self._core, path, False, jobs, progress)
            return read_store(path)


class Table:
    """The results of a study, a row a point."""

    def __init__(self, core):
        self._core = core

    @property
    def name(self):
        return self._core.name

    @property
    def behaviour(self):
        """The number of behaviour of the takt that made it (takt.behaviour is that of this one); 0: it names none."""
        return self._core.behaviour

    @property
    def factors(self):
        return self._core.factors

    @property
    def measures(self):
        return self._core.measures

    def measure(self, name):
        """The values of a measure by row, in its unit; NaN where there is none. A NumPy array without a copy."""
        return self._core.measure(name)

    def unit(self, name):
        """Of a measure."""
        return self._core.unit(name)

    def factor(self, name):
        """Of a factor: level (an index by row), texts and numbers (by level), unit."""
        return Record(self._core.factor(name))

    def to_pandas(self):
        """A DataFrame with a column for each factor and measure, and passes, status, replication."""
        import pandas
        columns = {}
        for name in self.factors:
            factor = self.factor(name)
            columns[name] = pandas.Categorical.from_codes(factor.level, factor.texts)
        columns["replication"] = self._core.replication()
        for name in self.measures:
            columns[name] = self.measure(name)
        columns["passes"] = self._core.passes
        columns["status"] = self._core.status
        return pandas.DataFrame(columns, copy=False)

    def heatmap(self, rows, columns, measure):
        """A measure over two factors."""
        return Figure(self._core.heatmap(rows, columns, measure))

    def effect(self, factor, measure):
        """A measure over the levels of a factor, averaged over everything else."""
        return Figure(self._core.effect(factor, measure))

    def pareto(self, a, b):
        """Variants by two measures, those that no other beats in both joined."""
        return Figure(self._core.pareto(a, b))

    def summary(self):
        """What `takt study report` prints."""
        return self._core.summary()

    def report(self):
        """The report as HTML, as `takt study report` writes it."""
        return self._core.report()

    def __repr__(self):
        return f"<takt.Table {self.name}: {', '.join(self.factors)} -> {', '.join(self.measures)}>"
