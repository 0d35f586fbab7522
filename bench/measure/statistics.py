"""Medians and how sure one can be of them."""

from dataclasses import dataclass
from math import comb
from statistics import median


@dataclass
class Summary:
    count: int
    median: float
    smallest: float
    largest: float
    interval: tuple  # of the median
    confidence: float  # of the interval

    def as_json(self):
        return {
            "count": self.count,
            "median": self.median,
            "min": self.smallest,
            "max": self.largest,
            "interval": list(self.interval),
            "confidence": self.confidence,
        }


def summarise(values, confidence=0.95):
    """The interval lies between two order statistics, which assumes nothing of the distribution
    except that the values are independent: the k-th smallest and the k-th largest of n enclose the
    median with probability 1 - 2 P(B < k), B binomial with n and 1/2 (Thompson 1936). The largest k
    that keeps `confidence` is taken; below 6 values even k = 1 does not, and the actual confidence
    is returned."""
    ordered = sorted(values)
    n = len(ordered)

    def coverage(k):
        return 1 - 2 * sum(comb(n, i) for i in range(k)) / 2**n

    k = 1
    while k + 1 <= (n + 1) // 2 and coverage(k + 1) >= confidence:
        k += 1
    return Summary(
        n,
        median(ordered),
        ordered[0],
        ordered[-1],
        (ordered[k - 1], ordered[n - k]),
        max(coverage(k), 0.0),
    )
