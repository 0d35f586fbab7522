"""How far figures may be from those of the table."""

import dataclasses


@dataclasses.dataclass
class Bound:
    """How far a figure may be from the table's."""

    part: float
    least: int

    def allows(self, figure, expected):
        return abs(figure - expected) <= max(self.part * expected, self.least)


BOUNDS = {
    "instructions": Bound(0.02, 4),  # of PTX, in the kernel
    "inner loops": Bound(0.02, 4),  # those of its instructions that are in loops within loops
    "called": Bound(0.02, 4),  # instructions of the functions that it may call
    "local bytes": Bound(0.01, 8),  # arrays that are no values, of all functions
}
BOUNDS_OF_MACHINE_CODE = {
    "instructions": Bound(0.03, 16),
    "registers": Bound(0.05, 2),
    "stack bytes": Bound(0.03, 16),
    "spill store bytes": Bound(0.10, 16),
    "spill load bytes": Bound(0.10, 16),
}


def differences(expected, figures, bounds):
    """A line for each figure that is too far from the table's."""
    for program, row in figures.items():
        for name, figure in row.items():
            known = expected.get(program, {}).get(name)
            if known is None:
                yield f"{program}: {name}: {figure}, and nothing in the table"
            elif not bounds[name].allows(figure, known):
                kind = "worse" if figure > known else "better"
                change = f" ({figure / known - 1:+.1%})" if known else ""
                yield f"{program}: {name}: {figure} instead of {known}{change}, {kind}"
    for program in sorted(expected.keys() - figures.keys()):
        yield f"{program}: in the table, but not measured"
