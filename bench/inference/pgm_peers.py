"""Others' exact inference on the network's own tables: pgmpy and, where it is there, pyAgrum."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np


def pgmpy_query(model: Any, asked: str, told: Mapping[str, str]) -> Callable[[], Sequence[float]]:
    """A question to pgmpy's variable elimination, ready to be asked again and again."""
    from pgmpy.inference import VariableElimination  # Loaded for this part alone: it takes seconds.

    elimination = VariableElimination(model)

    def ask() -> Sequence[float]:
        found = elimination.query([asked], evidence=dict(told), show_progress=False)
        return [
            float(found.get_value(**{asked: s})) for s in model.get_cpds(asked).state_names[asked]
        ]

    return ask


def pyagrum_query(model: Any, asked: str, told: Mapping[str, str]) -> Callable[[], Sequence[float]]:
    """The same question to pyAgrum's lazy propagation; ImportError where it is not installed."""
    import pyagrum as gum

    net = as_pyagrum(gum, model)
    inference = gum.LazyPropagation(net)
    inference.setTargets({asked})

    def ask() -> Sequence[float]:
        inference.setEvidence(dict(told))
        inference.makeInference()
        return [float(p) for p in inference.posterior(asked).tolist()]

    return ask


def as_pyagrum(gum: Any, model: Any) -> Any:
    """A pgmpy model's variables, states and tables as pyAgrum's."""
    net = gum.BayesNet()
    for name in model.nodes:
        net.add(gum.LabelizedVariable(name, name, model.get_cpds(name).state_names[name]))
    for name in model.nodes:
        for parent in model.get_cpds(name).variables[1:]:
            net.addArc(parent, name)
    for name in model.nodes:
        own = model.get_cpds(name)
        order = list(reversed(net.cpt(name).names))  # of its array's axes
        axes = [own.variables.index(variable) for variable in order]
        net.cpt(name)[:] = np.ascontiguousarray(np.transpose(own.values, axes))
    return net
