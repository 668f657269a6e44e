"""The errors a user can cause, typed by cause; each message says what, where, and what to do."""


class AfkbError(Exception):
    """Root of every error that is the input's fault, not the program's."""


class SourceError(AfkbError):
    """A recording that can't be opened or has nothing usable in it."""


class BadFrame(AfkbError):
    """One frame that can't be used; the run skips it, counts it, and goes on."""


class KnowledgeError(AfkbError):
    """An ontology or extension that can't be read or contradicts itself.

    Its text has a line for each problem, where several were found at once.
    """


class EvidenceError(AfkbError):
    """Evidence that the network gives probability zero, or that names no known variable."""


class PluginError(AfkbError):
    """A plugin that doesn't load, is unknown by name, or breaks its contract."""


class MapError(AfkbError):
    """A map folder that can't be read or must not be overwritten."""


class QueryError(AfkbError):
    """A SPARQL query that can't be parsed or isn't allowed."""


class RouteError(AfkbError):
    """A route that isn't there, or whose ends name nothing in the map."""


class EndpointError(AfkbError):
    """A SPARQL server that can't be reached, or that refuses what it is asked."""
