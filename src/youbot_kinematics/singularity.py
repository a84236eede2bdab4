"""Singular configurations of the arm: how near, and of which kind.

In the frame of the arm's vertical plane (x along it, y across it, z up) the Jacobian falls into two
blocks, since joints 2, 3 and 4 move the tool in the plane and joints 1 and 5 across it::

                     joints 2, 3, 4                        joints 1, 5
    v_x, v_z, w_y    in the plane, 3x3
    v_y, w_x, w_z                                          across it, 3x2

Turning the frame and reordering rows keeps singular values, so those of the Jacobian are those of
the two blocks together, and the arm is singular in one of these ways, and no other:

* ``elbow``: the determinant of the first block is 0.155 m * 0.135 m * sin(elbow angle). It is zero
  for a straight elbow (q3 = -146 degrees; folded, it is outside of joint 3's limits).
* ``wrist``: joint 1 gives (v_y, w_x, w_z) = -(r, 0, 1), joint 5 gives -(0, sin beta, cos beta),
  with the reach r of the tool and its pitch beta. They are parallel where r = 0 and sin beta = 0:
  the tool is vertical on joint 1's axis, and both joints turn about one line.

Its position part, the rows v, loses joint 5, on whose axis the tool is. Its singular values are
``|r|`` and those of the two rows v_x, v_z of joints 2 to 4:

* ``shoulder``: r = 0, the tool is on joint 1's axis. Every ``wrist`` singularity is one of these.
* ``stretch``: shoulder, elbow, wrist and tool on one line. Every one is an ``elbow`` singularity.

So ``elbow`` and ``wrist`` are the singularities of the whole Jacobian (rank below 5), ``shoulder``
and ``stretch`` those of its position part (rank below 3). Joint limits play no part in this.

Source: Siciliano et al., "Robotics: Modelling, Planning and Control" (2009), sections 3.3 and 3.9.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .arm import OFFSET, SIGN

#: A singular value below this (m/rad for the rows of the position, 1 for the orientation) counts as
#: zero. With it, an elbow within about 0.5 degrees of straight is singular.
SINGULARITY_THRESHOLD = 1e-3

_ACROSS, _IN_PLANE = [1, 3, 5], [0, 2, 4]  # rows of v_x, v_y, v_z, w_x, w_y, w_z


class Singularities(NamedTuple):
    """Which kinds of singularity the arm is in: bool (...) each. The module says what they are."""

    shoulder: np.ndarray
    elbow: np.ndarray
    wrist: np.ndarray
    stretch: np.ndarray

    def names(self) -> list[str]:
        """Names of the kinds that a single configuration is in."""
        return [name for name, singular in zip(self._fields, self) if singular]


def smallest_singular_value(J: np.ndarray) -> np.ndarray:
    """Smallest singular value (...) of Jacobians (..., m, n)."""
    return np.linalg.svd(J, compute_uv=False)[..., -1]


def manipulability(J: np.ndarray) -> np.ndarray:
    """Yoshikawa's measure (...) of Jacobians (..., m, n): the product of the singular values.

    It is the square root of det(J J^T), or of det(J^T J) for m > n, where that is not zero anyway.
    """
    return np.linalg.svd(J, compute_uv=False).prod(axis=-1)


def classify(q: np.ndarray, J: np.ndarray) -> Singularities:
    """The kinds of singularity of joints (..., 5), rad, with their Jacobians (..., 6, 5)."""
    phi = OFFSET[0] + SIGN[0] * q[..., 0]
    cos, sin, zero = np.cos(phi), np.sin(phi), np.zeros_like(phi)
    to_plane = np.stack([cos, sin, zero, -sin, cos, zero, zero, zero, zero + 1], axis=-1)
    to_plane = to_plane.reshape(*phi.shape, 3, 3)
    rows = np.concatenate([to_plane @ J[..., :3, :], to_plane @ J[..., 3:, :]], axis=-2)
    in_plane = rows[..., _IN_PLANE, 1:4]
    across = rows[..., _ACROSS, :][..., [0, 4]]
    values = {
        "shoulder": np.abs(across[..., 0, 0]),
        "elbow": smallest_singular_value(in_plane),
        "wrist": smallest_singular_value(across),
        "stretch": smallest_singular_value(in_plane[..., :2, :]),
    }
    return Singularities(**{name: value < SINGULARITY_THRESHOLD for name, value in values.items()})
