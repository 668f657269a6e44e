"""A process that maps one recording: the job comes on stdin, what became of it goes to stdout.

When whoever started it dies, stdin ends, and the process ends with it, at once. The map's folder is
then the old one or the new one, as whenever a run is killed.
"""

from __future__ import annotations

import json
import os
import sys
import threading
from typing import Any

from afkb.errors import AfkbError
from afkb_mapping.batch.job import Job

ABANDONED = 75


def main() -> None:
    """Do the one job."""
    job = Job.from_json(json.loads(sys.stdin.readline()))
    threading.Thread(target=_end_with_stdin, daemon=True).start()
    told = _told(job)
    sys.stdout.write(json.dumps(told) + "\n")
    sys.stdout.flush()


def _end_with_stdin() -> None:
    sys.stdin.read()
    os._exit(ABANDONED)


def _told(job: Job) -> dict[str, Any]:
    """The map's figures, or in one line why there is none."""
    try:
        return _mapped(job)
    except (AfkbError, OSError) as error:
        return {"error": " ".join(str(error).split())}
    except MemoryError:
        return {"error": "out of memory"}
    except Exception as error:
        # What a stranger's plugin does wrong ends this recording and no other.
        return {"error": f"unexpected {type(error).__name__}: {' '.join(str(error).split())}"}


def _mapped(job: Job) -> dict[str, Any]:
    from afkb.flow import NodeKind
    from afkb.plugins.host import PluginHost
    from afkb_mapping.run import make_map

    result = make_map(PluginHost(extensions=job.ontology), job.settings)
    found, run = result.topological_map, result.run
    frames = run["frames"]
    assert isinstance(frames, dict)
    return {
        "frames": frames["used"],
        "skipped_frames": frames["skipped"],
        "things": sum(e.kind is NodeKind.OBSERVED for e in found.entities),
        "rooms": len(found.rooms),
        "peak_memory_mb": run["peak_memory_mb"],
    }


if __name__ == "__main__":
    main()
