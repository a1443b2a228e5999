# SPDX-License-Identifier: Apache-2.0
"""Objects with the names of result.json: r.streams["camera"].latency_ps.max."""
from collections.abc import Mapping


class Record(Mapping):
    """An object of takt's JSON. Members are attributes, and items where their names are people's own: r.programs["arm"]."""

    __slots__ = ("_members",)

    def __init__(self, members):
        object.__setattr__(self, "_members", members)

    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"there is no {name!r}; there are {', '.join(map(str, self._members))}") from None

    def __setattr__(self, name, value):
        raise AttributeError("results do not change")

    def __getitem__(self, name):
        return wrapped(self._members[name])

    def __iter__(self):
        return iter(self._members)

    def __len__(self):
        return len(self._members)

    def __dir__(self):
        return [*super().__dir__(), *self._members]

    def __repr__(self):
        return f"Record({self._members!r})"

    def to_dict(self):
        """The plain dictionary that this looks into."""
        return self._members


def wrapped(value):
    if isinstance(value, dict):
        return Record(value)
    if isinstance(value, list):
        return [wrapped(each) for each in value]
    return value
