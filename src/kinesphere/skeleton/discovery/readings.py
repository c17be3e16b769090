"""Every way to see a tree as a person."""

from collections.abc import Iterator, Sequence
from itertools import combinations, product

from kinesphere.skeleton.discovery.figure import Figure
from kinesphere.skeleton.discovery.person import Arm, Person


def readings(figure: Figure, tree: Sequence[int]) -> Iterator[Person]:
    """Yield every way to see two legs, up to two arms and up to one head in a tree."""
    for trunk in tree:
        for pelvis in (None, *figure.beside[trunk]):
            base = trunk if pelvis is None else pelvis
            lower = [b for b in figure.beside[base] if b != trunk]
            for pair in combinations(lower, 2):
                legs = tuple(figure.chain(base, start)[:3] for start in pair)
                if min(len(leg) for leg in legs) < 2:
                    continue
                used = {pelvis, *pair}
                upper = [b for b in figure.beside[trunk] if b not in used]
                for arms in _arm_sets(figure, trunk, upper):
                    taken = {b for at, arm in arms for b in (at, *arm)}
                    for head in (None, *(b for b in upper if b not in taken)):
                        yield Person(trunk, pelvis, (legs[0], legs[1]), arms, head)


def _arm_sets(figure: Figure, trunk: int, upper: list[int]) -> Iterator[tuple[Arm, ...]]:
    """Yield up to two arms; the first of three and more bodies in a row may be a shoulder blade."""
    chains = [figure.chain(trunk, b) for b in upper]
    for count in range(3):
        for chosen in combinations(chains, count):
            yield from product(*(_ways(trunk, chain) for chain in chosen))


def _ways(trunk: int, chain: tuple[int, ...]) -> list[Arm]:
    """Return how a chain can be an arm: with or without a shoulder blade, a hand, a tool in it.

    One body by itself can be an arm without a bend.
    """
    whole = [(trunk, chain[:3]), *([(chain[0], chain[1:4])] if len(chain) > 2 else [])]
    return [*whole, *((at, arm[:2]) for at, arm in whole if len(arm) > 2)]
