"""Covariance of the nine error states, in straight-line scalar code.

States: dp (position, m), dv (velocity, m/s), dt (attitude, rad, small turn in the world frame: R_true = exp([dt]x) R).
`Covariance` is the upper triangle of the symmetric 9x9 matrix, block by block: pp (6), pv (9), pt (9), vv (6), vt (9),
tt (6). The names contain both states: `vtxz` is the covariance of dv_x and dt_z.

No part needs the covariance between two corrections, so it is propagated over the whole interval T in one step. Let f
be the specific force in the world frame, S the integral and D the double integral of f over time. With a constant
attitude error over T, the error equations dp' = dv, dv' = -[f]x dt (Sola 2017, section 7) integrate exactly to

    dp(T) = dp + T dv + M2 dt,  M2 = -[D]x      dv(T) = dv + M1 dt,  M1 = -[S]x      dt(T) = dt

The lines below are the blocks of P <- F P F' + Q and of the Kalman update by a measured velocity, H = [0 I 0].
tests/foot/navigate/test_covariance.py compares them with the matrix form."""

from __future__ import annotations

from math import sqrt

from ...types import Vec3

Covariance = tuple[float, ...]
"""Upper triangle of the covariance, 45 numbers: blocks pp, pv, pt, vv, vt, tt."""

Correction = tuple[float, ...]
"""Values to add to the nine states: position (m), velocity (m/s) and attitude (rad), each x, y, z."""

P, V, T = (0, 1, 2), (3, 4, 5), (6, 7, 8)
"""Indices of the states: position, velocity, attitude."""
PAIRS = [
    (i, j)
    for rows, columns in ((P, P), (P, V), (P, T), (V, V), (V, T), (T, T))
    for i in rows
    for j in columns
    if rows != columns or i <= j
]
"""Pair of states of each number of a Covariance."""
HEIGHT_COUNTS = [pair.count(2) for pair in PAIRS]
"""How often the height, state 2, is in each pair."""
HEIGHT = PAIRS.index((2, 2))
"""Index of the variance of the height in a Covariance."""


def propagate(
    covariance: Covariance, dt: float, s: Vec3, d: Vec3, q_pp: float, q_pv: float, q_vv: float, q_tt: float
) -> Covariance:
    """Return P <- F P F' + Q over an interval of `dt` s.

    `s` (m/s) and `d` (m) are S and D of the module, q_* are the blocks of the noise Q."""
    sx, sy, sz = s
    dx, dy, dz = d
    (
        ppxx, ppxy, ppxz, ppyy, ppyz, ppzz,
        pvxx, pvxy, pvxz, pvyx, pvyy, pvyz, pvzx, pvzy, pvzz,
        ptxx, ptxy, ptxz, ptyx, ptyy, ptyz, ptzx, ptzy, ptzz,
        vvxx, vvxy, vvxz, vvyy, vvyz, vvzz,
        vtxx, vtxy, vtxz, vtyx, vtyy, vtyz, vtzx, vtzy, vtzz,
        ttxx, ttxy, ttxz, ttyy, ttyz, ttzz,
    ) = covariance  # fmt: skip
    # a = cov(dp + T dv, dtheta)
    axx = ptxx + dt * vtxx
    axy = ptxy + dt * vtxy
    axz = ptxz + dt * vtxz
    ayx = ptyx + dt * vtyx
    ayy = ptyy + dt * vtyy
    ayz = ptyz + dt * vtyz
    azx = ptzx + dt * vtzx
    azy = ptzy + dt * vtzy
    azz = ptzz + dt * vtzz
    # pp' = pp + T (pv + pv') + T^2 vv + a M2' + M2 (a + M2 tt)'
    nxx = axx + dz * ttxy - dy * ttxz
    nxy = axy + dz * ttyy - dy * ttyz
    nxz = axz + dz * ttyz - dy * ttzz
    nyx = ayx - dz * ttxx + dx * ttxz
    nyy = ayy - dz * ttxy + dx * ttyz
    nyz = ayz - dz * ttxz + dx * ttzz
    nzx = azx + dy * ttxx - dx * ttxy
    nzy = azy + dy * ttxy - dx * ttyy
    nzz = azz + dy * ttxz - dx * ttyz
    ppxx = ppxx + dt * (2.0 * pvxx + dt * vvxx) + dz * axy - dy * axz + dz * nxy - dy * nxz + q_pp
    ppxy = ppxy + dt * (pvxy + pvyx + dt * vvxy) - dz * axx + dx * axz + dz * nyy - dy * nyz
    ppxz = ppxz + dt * (pvxz + pvzx + dt * vvxz) + dy * axx - dx * axy + dz * nzy - dy * nzz
    ppyy = ppyy + dt * (2.0 * pvyy + dt * vvyy) - dz * ayx + dx * ayz - dz * nyx + dx * nyz + q_pp
    ppyz = ppyz + dt * (pvyz + pvzy + dt * vvyz) + dy * ayx - dx * ayy - dz * nzx + dx * nzz
    ppzz = ppzz + dt * (2.0 * pvzz + dt * vvzz) + dy * azx - dx * azy + dy * nzx - dx * nzy + q_pp
    # pt' = a + M2 tt;  pv' = pv + T vv + M2 vt' + pt' M1'
    pvxx = pvxx + dt * vvxx + dz * vtxy - dy * vtxz + sz * nxy - sy * nxz + q_pv
    pvxy = pvxy + dt * vvxy + dz * vtyy - dy * vtyz - sz * nxx + sx * nxz
    pvxz = pvxz + dt * vvxz + dz * vtzy - dy * vtzz + sy * nxx - sx * nxy
    pvyx = pvyx + dt * vvxy - dz * vtxx + dx * vtxz + sz * nyy - sy * nyz
    pvyy = pvyy + dt * vvyy - dz * vtyx + dx * vtyz - sz * nyx + sx * nyz + q_pv
    pvyz = pvyz + dt * vvyz - dz * vtzx + dx * vtzz + sy * nyx - sx * nyy
    pvzx = pvzx + dt * vvxz + dy * vtxx - dx * vtxy + sz * nzy - sy * nzz
    pvzy = pvzy + dt * vvyz + dy * vtyx - dx * vtyy - sz * nzx + sx * nzz
    pvzz = pvzz + dt * vvzz + dy * vtzx - dx * vtzy + sy * nzx - sx * nzy + q_pv
    # vt' = vt + M1 tt;  vv' = vv + vt M1' + M1 vt''
    wxx = vtxx + sz * ttxy - sy * ttxz
    wxy = vtxy + sz * ttyy - sy * ttyz
    wxz = vtxz + sz * ttyz - sy * ttzz
    wyx = vtyx - sz * ttxx + sx * ttxz
    wyy = vtyy - sz * ttxy + sx * ttyz
    wyz = vtyz - sz * ttxz + sx * ttzz
    wzx = vtzx + sy * ttxx - sx * ttxy
    wzy = vtzy + sy * ttxy - sx * ttyy
    wzz = vtzz + sy * ttxz - sx * ttyz
    vvxx = vvxx + sz * vtxy - sy * vtxz + sz * wxy - sy * wxz + q_vv
    vvxy = vvxy - sz * vtxx + sx * vtxz + sz * wyy - sy * wyz
    vvxz = vvxz + sy * vtxx - sx * vtxy + sz * wzy - sy * wzz
    vvyy = vvyy - sz * vtyx + sx * vtyz - sz * wyx + sx * wyz + q_vv
    vvyz = vvyz + sy * vtyx - sx * vtyy - sz * wzx + sx * wzz
    vvzz = vvzz + sy * vtzx - sx * vtzy + sy * wzx - sx * wzy + q_vv
    ttxx += q_tt
    ttyy += q_tt
    ttzz += q_tt
    return (
        ppxx, ppxy, ppxz, ppyy, ppyz, ppzz,
        pvxx, pvxy, pvxz, pvyx, pvyy, pvyz, pvzx, pvzy, pvzz,
        nxx, nxy, nxz, nyx, nyy, nyz, nzx, nzy, nzz,
        vvxx, vvxy, vvxz, vvyy, vvyz, vvzz,
        wxx, wxy, wxz, wyx, wyy, wyz, wzx, wzy, wzz,
        ttxx, ttxy, ttxz, ttyy, ttyz, ttzz,
    )  # fmt: skip


def update(
    covariance: Covariance, zx: float, zy: float, zz: float, r: float, limit: float
) -> tuple[Covariance, Correction] | None:
    """Correct by an innovation z = measured - estimated velocity (m/s), with variance r (m^2/s^2) on each axis.

    Returns the new P and the corrections of the nine states. Returns None if the squared innovation, weighted by its
    covariance, exceeds `limit`, because such a measurement is most likely not of this velocity."""
    (
        ppxx, ppxy, ppxz, ppyy, ppyz, ppzz,
        pvxx, pvxy, pvxz, pvyx, pvyy, pvyz, pvzx, pvzy, pvzz,
        ptxx, ptxy, ptxz, ptyx, ptyy, ptyz, ptzx, ptzy, ptzz,
        vvxx, vvxy, vvxz, vvyy, vvyz, vvzz,
        vtxx, vtxy, vtxz, vtyx, vtyy, vtyz, vtzx, vtzy, vtzz,
        ttxx, ttxy, ttxz, ttyy, ttyz, ttzz,
    ) = covariance  # fmt: skip
    # S = H P H' + r I is the block vv with r on its diagonal; its inverse by cofactors
    sxx = vvxx + r
    syy = vvyy + r
    szz = vvzz + r
    cxx = syy * szz - vvyz * vvyz
    cxy = vvyz * vvxz - vvxy * szz
    cxz = vvxy * vvyz - syy * vvxz
    k = 1.0 / (sxx * cxx + vvxy * cxy + vvxz * cxz)
    ixx, ixy, ixz = cxx * k, cxy * k, cxz * k
    iyy, iyz, izz = (sxx * szz - vvxz * vvxz) * k, (vvxy * vvxz - sxx * vvyz) * k, (sxx * syy - vvxy * vvxy) * k
    # w = S^-1 z; z'w is the normalised innovation squared, chi-square with three degrees of freedom
    wx = ixx * zx + ixy * zy + ixz * zz
    wy = ixy * zx + iyy * zy + iyz * zz
    wz = ixz * zx + iyz * zy + izz * zz
    if zx * wx + zy * wy + zz * wz > limit:
        return None
    # gains K = P H' S^-1; the rows of P H' are pv, vv and the transpose of vt
    kpxx = pvxx * ixx + pvxy * ixy + pvxz * ixz
    kpxy = pvxx * ixy + pvxy * iyy + pvxz * iyz
    kpxz = pvxx * ixz + pvxy * iyz + pvxz * izz
    kpyx = pvyx * ixx + pvyy * ixy + pvyz * ixz
    kpyy = pvyx * ixy + pvyy * iyy + pvyz * iyz
    kpyz = pvyx * ixz + pvyy * iyz + pvyz * izz
    kpzx = pvzx * ixx + pvzy * ixy + pvzz * ixz
    kpzy = pvzx * ixy + pvzy * iyy + pvzz * iyz
    kpzz = pvzx * ixz + pvzy * iyz + pvzz * izz
    kvxx = vvxx * ixx + vvxy * ixy + vvxz * ixz
    kvxy = vvxx * ixy + vvxy * iyy + vvxz * iyz
    kvxz = vvxx * ixz + vvxy * iyz + vvxz * izz
    kvyy = vvxy * ixy + vvyy * iyy + vvyz * iyz
    kvyz = vvxy * ixz + vvyy * iyz + vvyz * izz
    kvzz = vvxz * ixz + vvyz * iyz + vvzz * izz
    ktxx = vtxx * ixx + vtyx * ixy + vtzx * ixz
    ktxy = vtxx * ixy + vtyx * iyy + vtzx * iyz
    ktxz = vtxx * ixz + vtyx * iyz + vtzx * izz
    ktyx = vtxy * ixx + vtyy * ixy + vtzy * ixz
    ktyy = vtxy * ixy + vtyy * iyy + vtzy * iyz
    ktyz = vtxy * ixz + vtyy * iyz + vtzy * izz
    ktzx = vtxz * ixx + vtyz * ixy + vtzz * ixz
    ktzy = vtxz * ixy + vtyz * iyy + vtzz * iyz
    ktzz = vtxz * ixz + vtyz * iyz + vtzz * izz
    # P <- P - K H P where neither state is a velocity
    ppxx -= kpxx * pvxx + kpxy * pvxy + kpxz * pvxz
    ppxy -= kpxx * pvyx + kpxy * pvyy + kpxz * pvyz
    ppxz -= kpxx * pvzx + kpxy * pvzy + kpxz * pvzz
    ppyy -= kpyx * pvyx + kpyy * pvyy + kpyz * pvyz
    ppyz -= kpyx * pvzx + kpyy * pvzy + kpyz * pvzz
    ppzz -= kpzx * pvzx + kpzy * pvzy + kpzz * pvzz
    ptxx -= kpxx * vtxx + kpxy * vtyx + kpxz * vtzx
    ptxy -= kpxx * vtxy + kpxy * vtyy + kpxz * vtzy
    ptxz -= kpxx * vtxz + kpxy * vtyz + kpxz * vtzz
    ptyx -= kpyx * vtxx + kpyy * vtyx + kpyz * vtzx
    ptyy -= kpyx * vtxy + kpyy * vtyy + kpyz * vtzy
    ptyz -= kpyx * vtxz + kpyy * vtyz + kpyz * vtzz
    ptzx -= kpzx * vtxx + kpzy * vtyx + kpzz * vtzx
    ptzy -= kpzx * vtxy + kpzy * vtyy + kpzz * vtzy
    ptzz -= kpzx * vtxz + kpzy * vtyz + kpzz * vtzz
    ttxx -= ktxx * vtxx + ktxy * vtyx + ktxz * vtzx
    ttxy -= ktxx * vtxy + ktxy * vtyy + ktxz * vtzy
    ttxz -= ktxx * vtxz + ktxy * vtyz + ktxz * vtzz
    ttyy -= ktyx * vtxy + ktyy * vtyy + ktyz * vtzy
    ttyz -= ktyx * vtxz + ktyy * vtyz + ktyz * vtzz
    ttzz -= ktzx * vtxz + ktzy * vtyz + ktzz * vtzz
    return (
        (
            ppxx, ppxy, ppxz, ppyy, ppyz, ppzz,
            # P H' - K H P H' = K (S - H P H') = K r: the columns of the velocity become r K
            r * kpxx, r * kpxy, r * kpxz, r * kpyx, r * kpyy, r * kpyz, r * kpzx, r * kpzy, r * kpzz,
            ptxx, ptxy, ptxz, ptyx, ptyy, ptyz, ptzx, ptzy, ptzz,
            r * kvxx, r * kvxy, r * kvxz, r * kvyy, r * kvyz, r * kvzz,
            r * ktxx, r * ktyx, r * ktzx, r * ktxy, r * ktyy, r * ktzy, r * ktxz, r * ktyz, r * ktzz,
            ttxx, ttxy, ttxz, ttyy, ttyz, ttzz,
        ),
        # P H' w
        (
            pvxx * wx + pvxy * wy + pvxz * wz,
            pvyx * wx + pvyy * wy + pvyz * wz,
            pvzx * wx + pvzy * wy + pvzz * wz,
            vvxx * wx + vvxy * wy + vvxz * wz,
            vvxy * wx + vvyy * wy + vvyz * wz,
            vvxz * wx + vvyz * wy + vvzz * wz,
            vtxx * wx + vtyx * wy + vtzx * wz,
            vtxy * wx + vtyy * wy + vtzy * wz,
            vtxz * wx + vtyz * wy + vtzz * wz,
        ),
    )  # fmt: skip


def squared_innovation(covariance: Covariance, ix: float, iy: float, iz: float, r: float) -> float:
    """Return the squared innovation of a velocity, weighted by its covariance S = H P H' + r I; no unit, 3 on average.

    `ix`, `iy`, `iz` is the innovation, m/s, and `r` the variance of the evidence, (m/s)^2, as in `update`."""
    xx, xy, xz, yy, yz, zz = covariance[24:30]
    xx += r
    yy += r
    zz += r
    cxx, cxy, cxz = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
    cyy, cyz, czz = xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy
    weighted = ix * (cxx * ix + 2.0 * (cxy * iy + cxz * iz)) + iy * (cyy * iy + 2.0 * cyz * iz) + czz * iz * iz
    return weighted / (xx * cxx + xy * cxy + xz * cxz)


def scale(covariance: Covariance, factor: float) -> Covariance:
    """Return the covariance times `factor`: a fading memory (Bar-Shalom et al. 2001)."""
    return tuple([factor * p for p in covariance])


def inflate(
    covariance: Covariance, velocity: float, tilt: float, position: float = 0.0, height: float = 0.0, yaw: float = 0.0
) -> Covariance:
    """Return the covariance with these variances added: of velocity, (m/s)^2, position, m^2, and of the angles, rad^2.

    `velocity` is that of each axis, `position` that of x and y, `tilt` that about each horizontal axis."""
    added = (position, position, height, velocity, velocity, velocity, tilt, tilt, yaw)
    return tuple([p + added[i] if i == j else p for p, (i, j) in zip(covariance, PAIRS, strict=True)])


def add_error(covariance: Covariance, error: tuple[Vec3, Vec3, Vec3], sigma: float) -> Covariance:
    """Return P + sigma^2 b b' for an error of standard deviation `sigma` in the direction b = `error`.

    `error` is that of position, velocity and attitude."""
    position, velocity, turn = error
    direction, k = (*position, *velocity, *turn), sigma * sigma
    return tuple([p + k * direction[i] * direction[j] for p, (i, j) in zip(covariance, PAIRS, strict=True)])


def forget_position_and_yaw(covariance: Covariance) -> Covariance:
    """Return the covariance of a foot whose position and yaw are known."""
    known = (*P, 8)
    return tuple([0.0 if i in known or j in known else p for p, (i, j) in zip(covariance, PAIRS, strict=True)])


def constrain_height(covariance: Covariance, remaining_share: float) -> Covariance:
    """Return the covariance after the height was corrected, with `remaining_share` (0 to 1) of its variance.

    P <- D P D, D = diag(1, 1, d, 1, ...) with d^2 = `remaining_share`. Other variances stay; the covariances with the
    height shrink."""
    factors = (1.0, sqrt(remaining_share), remaining_share)
    return tuple([factors[n] * p for n, p in zip(HEIGHT_COUNTS, covariance, strict=True)])
