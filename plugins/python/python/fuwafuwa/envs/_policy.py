"""Trained players as small files, which need nothing except numpy."""

from __future__ import annotations

import json
from os import PathLike
from typing import IO, Any

import numpy as np

from .._core import _network

#: Limit of normalized observations, the `clip_obs` of training.
_CLIP = 10.0


class Policy:
    """Player: a network with tanh layers that maps observations to actions.

    - layers: pairs of a weight matrix (outputs, inputs) and a bias (outputs,), float32
    - mean, scale: observations are normalized to (observation - mean) * scale, both (numbers,)
    - std: standard deviations of the noise that `random` adds to the actions, (outputs,); default 0
    - about: how the policy was trained, as a dict
    """

    def __init__(
        self,
        layers: list[tuple[np.ndarray, np.ndarray]],
        mean: np.ndarray,
        scale: np.ndarray,
        about: dict[str, Any] | None = None,
        std: np.ndarray | None = None,
    ) -> None:
        self.layers = layers
        self.mean = mean
        self.scale = scale
        self.about = dict(about or {})
        self.std = np.zeros(len(layers[-1][1]), np.float32) if std is None else std

    def __call__(self, observation: np.ndarray, random: np.random.Generator | None = None) -> np.ndarray:
        """Return the actions for one observation (numbers,) or several (count, numbers).

        Without `random` they are the most probable ones, with the same bits on every computer. With it they have noise, as in training, which frees a body that
        is stuck.
        """
        inputs = np.clip((observation - self.mean) * self.scale, -_CLIP, _CLIP).astype(np.float32)
        rows = _network(np.atleast_2d(inputs), self.layers)
        values: np.ndarray = rows.reshape(*inputs.shape[:-1], -1)
        if random is not None:
            values = values + self.std * random.standard_normal(values.shape)
        actions: np.ndarray = np.clip(values, -1.0, 1.0).astype(np.float32)
        return actions

    def save(self, path: str | PathLike[str]) -> None:
        """Write the policy as a file of numpy (npz)."""
        arrays: dict[str, Any] = {"mean": self.mean, "scale": self.scale, "std": self.std}
        arrays["about"] = np.array(json.dumps(self.about))
        for index, (weight, bias) in enumerate(self.layers):
            arrays |= {f"weight{index}": weight, f"bias{index}": bias}
        np.savez_compressed(path, **arrays)

    @classmethod
    def load(cls, path: str | PathLike[str] | IO[bytes]) -> Policy:
        """Read a policy from a file that `save` wrote: a path or an open file."""
        with np.load(path, allow_pickle=False) as file:
            count = sum(name.startswith("weight") for name in file.files)
            layers = [(file[f"weight{index}"], file[f"bias{index}"]) for index in range(count)]
            return cls(layers, file["mean"], file["scale"], json.loads(str(file["about"])), file["std"])
