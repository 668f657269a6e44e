"""Why a map believes what it believes: from pixels over evidence and axioms to probabilities."""

from afkb.explaining.explain import explain
from afkb.explaining.explanation import Explanation

__all__ = ["Explanation", "explain"]
