"""What a quality gate finds, and how it went."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

PASSED, FAILED, NOT_RUN = "passed", "failed", "not run"


@dataclass(frozen=True, slots=True, order=True)
class Finding:
    """Something to mend: where it stands, the term, what is wrong, how to mend it.

    `advice`: worth telling, and no reason to refuse the file.
    """

    place: str
    name: str
    what: str
    mend: str
    advice: bool = False

    def __str__(self) -> str:
        kind = "advice" if self.advice else ""
        head = ": ".join(filter(None, (self.place, kind, self.name, self.what)))
        return f"{head}; {self.mend}" if self.mend else head


def findings_of_error(error: Exception) -> list[Finding]:
    """The lines of an error as findings; each begins with its place."""
    found = []
    for line in str(error).splitlines():
        place, _, what = line.strip().partition(": ")
        found.append(Finding(place, "", what, "") if what else Finding("", "", place, ""))
    return found


@dataclass(frozen=True, slots=True)
class Gate:
    """How one gate went.

    `note`: what it looked at, or why it was not run.
    """

    name: str
    findings: Sequence[Finding] = field(default=())
    note: str = ""
    was_run: bool = True

    @property
    def failures(self) -> int:
        """How many findings are more than advice."""
        return sum(not finding.advice for finding in self.findings)

    @property
    def state(self) -> str:
        """Passed, failed or not run."""
        if not self.was_run:
            return NOT_RUN
        return FAILED if self.failures else PASSED

    def __str__(self) -> str:
        count = f" {self.failures}" if self.state == FAILED else ""
        advice = len(self.findings) - self.failures
        notes = [self.note] if self.note else []
        notes += [f"{advice} advised"] if advice else []
        note = f" ({'; '.join(notes)})" if notes else ""
        return f"{self.name}: {self.state}{count}{note}"
