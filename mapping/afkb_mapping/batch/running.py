"""A batch from its beginning to its end: what is to be done, who does it, what became of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from afkb.errors import AfkbError
from afkb.fleet import Keeper
from afkb.knowledge import AfNet
from afkb.store import check_out, load
from afkb.store.made_with import ontology_record
from afkb_mapping.batch.done import to_do
from afkb_mapping.batch.job import Job, JobState, Outcome
from afkb_mapping.batch.sharing import cores, outcomes
from afkb_mapping.batch.telling import shown
from afkb_mapping.run_record import Settings


@dataclass(eq=False)
class Batch:
    """Recordings to map, by what means; `outcomes` tells what became of each so far.

    - `settings`: what each map is called and how it is made. `extensions`: of the ontology.
    - `workers`: recordings at once on this machine, None for one per core; `memory_limit`: bytes of
      each; `scheduler`: address of a cluster's in place of this machine.
    - `seconds`: after which a recording is given up. `keeper`: where maps are sent to.
    """

    settings: Sequence[tuple[str, Settings]]
    extensions: tuple[Path, ...] = ()
    workers: int | None = None
    scheduler: str | None = None
    memory_limit: int | None = None
    seconds: float | None = None
    keeper: Keeper | None = None
    outcomes: list[Outcome] = field(default_factory=list)

    @cached_property
    def knowledge_base(self) -> AfNet:
        """The ontology that maps are made with."""
        from afkb.plugins.host import PluginHost

        return PluginHost(extensions=self.extensions).knowledge_base

    def run(self, resume: bool) -> None:
        """Map them all; with `resume`, what is mapped already is left as it is.

        Raises `SchedulerError`, and `KeyboardInterrupt` where someone stops it; what a recording
        does wrong is told in its outcome.
        """
        jobs = self._jobs(resume)
        with shown(len(self.settings)) as tell:
            for found in self._outcomes(jobs):
                outcome = self._kept(found)
                self.outcomes.append(outcome)
                tell(outcome)

    def _jobs(self, resume: bool) -> Iterator[Job | Outcome]:
        """What is to be done of each recording, or what became of it without anything to do."""
        record = ontology_record(self.knowledge_base.files)
        at_once = min(self._at_once, len(self.settings))
        for name, settings in self.settings:
            threads = max(1, cores() // at_once)
            job = Job(name, settings, self.extensions, threads, self.seconds)
            try:
                check_out(settings.out)
                wanted = (to_do(job, record) if resume else job) or _as_it_is(job)
            except AfkbError as error:
                yield Outcome.of(job, JobState.FAILED, error=str(error))
                continue
            yield wanted

    @property
    def _at_once(self) -> int:
        return self.workers or cores()

    def _outcomes(self, planned: Iterator[Job | Outcome]) -> Iterator[Outcome]:
        jobs: list[Job] = []
        for plan in planned:
            if isinstance(plan, Outcome):
                yield plan
            else:
                jobs.append(plan)
        if jobs:
            at_once = min(self._at_once, len(jobs))
            yield from outcomes(jobs, at_once, self.memory_limit, self.scheduler)

    def _kept(self, outcome: Outcome) -> Outcome:
        """The outcome with where its map is kept, if it is to be; a map that stands stays."""
        if self.keeper is None or outcome.state is JobState.FAILED:
            return outcome
        try:
            return outcome.and_(stored=self.keeper.keep(outcome.out, outcome.name).graph)
        except AfkbError as error:
            return outcome.and_(error=f"the map stands, but is not stored: {error}")


def _as_it_is(job: Job) -> Outcome:
    """The figures of a map that is there already."""
    stored = load(job.settings.out)
    kinds, counts = stored.kinds, stored.counts
    return Outcome.of(
        job,
        JobState.SKIPPED,
        frames=counts.get("frames", 0),
        skipped_frames=counts.get("skipped_frames", 0),
        things=kinds["ObservedEntity"],
        rooms=kinds["Room"],
    )
