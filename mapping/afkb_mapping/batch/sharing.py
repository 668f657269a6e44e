"""Shares jobs out to Dask's workers: processes of this machine, or a cluster."""

from __future__ import annotations

import logging
import os
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING

from afkb.errors import AfkbError
from afkb_mapping.batch.job import Job, JobState, Outcome
from afkb_mapping.batch.watched import mapped_by_worker

if TYPE_CHECKING:
    from distributed import Client

CONNECT_WITHIN_S = 20.0
"""How long a scheduler may take to answer, s."""


class SchedulerError(AfkbError):
    """A Dask scheduler that can't be reached, or has no workers."""


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def outcomes(
    jobs: Sequence[Job],
    workers: int,
    memory_limit: int | None = None,
    scheduler: str | None = None,
) -> Iterator[Outcome]:
    """What became of each job, in the order in which they end.

    `workers`: processes of this machine; `memory_limit`: bytes of each, by default an equal share
    of the machine's. `scheduler`: address of a cluster's, whose workers see the same files and
    have limits of their own. A worker that dies is replaced and its recording mapped anew.
    Raises `SchedulerError`.
    """
    from distributed import as_completed

    with ExitStack() as stack:
        client = _client(stack, workers, memory_limit, scheduler)
        futures = client.map(mapped_by_worker, jobs, pure=False, retries=0)
        job_of = {future.key: job for future, job in zip(futures, jobs, strict=True)}
        for future in as_completed(futures):
            yield _outcome(future, job_of[future.key])


def _client(
    stack: ExitStack, workers: int, memory_limit: int | None, scheduler: str | None
) -> Client:
    from distributed import Client, LocalCluster
    from distributed.system import MEMORY_LIMIT

    if scheduler is None:
        cluster = LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            memory_limit=memory_limit or MEMORY_LIMIT // workers,
            dashboard_address=None,
            silence_logs=logging.CRITICAL,
        )
        return stack.enter_context(Client(stack.enter_context(cluster)))
    try:
        client = stack.enter_context(Client(scheduler, timeout=CONNECT_WITHIN_S))
    except (OSError, ValueError, TimeoutError) as error:
        raise SchedulerError(
            f"{scheduler}: no Dask scheduler answers there ({error}); start one with "
            "`dask scheduler`, and its workers with `dask worker ADDRESS`"
        ) from error
    if not client.scheduler_info(n_workers=-1)["workers"]:
        raise SchedulerError(f"{scheduler}: has no workers; start some: dask worker {scheduler}")
    return client


def _outcome(future: object, job: Job) -> Outcome:
    try:
        found = future.result()  # type: ignore[attr-defined]
        assert isinstance(found, Outcome)
        return found
    except Exception as error:
        why = " ".join(str(error).split())[:300]
        told = f"its worker failed: {type(error).__name__}: {why}"
        return Outcome.of(job, JobState.FAILED, error=told)
