"""The plugin host: hook specifications, and the one door through which every plugin comes.

>>> from afkb.plugins import hookimpl
"""

import pluggy

PROJECT = "afkb"
hookspec = pluggy.HookspecMarker(PROJECT)
hookimpl = pluggy.HookimplMarker(PROJECT)

__all__ = ["PROJECT", "hookimpl", "hookspec"]
