"""The covariance of the nine error states, in straight-line scalar code.

States: dp (position, m), dv (velocity, m/s), dt (attitude, rad, small turn in the world frame: R_true = exp([dt]x) R).
`Covariance` holds the upper triangle of the symmetric 9x9 matrix, block by block: pp (6), pv (9), pt (9), vv (6),
vt (9), tt (6); the names say which states meet, so `vtxz` is the covariance of dv_x and dt_z.

Between two corrections nobody needs the covariance, so it is carried over the whole interval T at once. With
S = integral of f dt and D = double integral of f dt^2 (f: specific force in the world frame), and the attitude error
constant over T, the error equations dp' = dv, dv' = -[f]x dt (Sola 2017, section 7) integrate exactly to

    dp(T) = dp + T dv + M2 dt,  M2 = -[D]x      dv(T) = dv + M1 dt,  M1 = -[S]x      dt(T) = dt

The lines below are the blocks of P <- F P F' + Q and of the Kalman update by a measured velocity, H = [0 I 0];
tests/test_covariance.py holds them against the matrix form.
"""

from __future__ import annotations

from math import sqrt

Covariance = tuple[float, ...]
"""45 numbers: pp, pv, pt, vv, vt, tt."""

Correction = tuple[float, float, float, float, float, float, float, float, float]
"""What to add to dp, dv and dt: m, m/s, rad."""

HEIGHT = 5
"""Where the variance of the height stands in a Covariance."""
VELOCITY_X, VELOCITY_Y, VELOCITY_Z = 24, 27, 29
"""Where the variances of the velocity stand."""
TILT_X, TILT_Y, YAW = 39, 42, 44
"""Where the variances of the attitude stand."""


def propagate(
    covariance: Covariance,
    dt: float,
    s: tuple[float, float, float],
    d: tuple[float, float, float],
    q_pp: float,
    q_pv: float,
    q_vv: float,
    q_tt: float,
) -> Covariance:
    """P <- F P F' + Q over an interval of `dt` s; `s` (m/s) and `d` (m) are S and D as above, q_* the noise added."""
    sx, sy, sz = s
    dx, dy, dz = d
    (
        ppxx, ppxy, ppxz, ppyy, ppyz, ppzz,
        pvxx, pvxy, pvxz, pvyx, pvyy, pvyz, pvzx, pvzy, pvzz,
        ptxx, ptxy, ptxz, ptyx, ptyy, ptyz, ptzx, ptzy, ptzz,
        vvxx, vvxy, vvxz, vvyy, vvyz, vvzz,
        vtxx, vtxy, vtxz, vtyx, vtyy, vtyz, vtzx, vtzy, vtzz,
        ttxx, ttxy, ttxz, ttyy, ttyz, ttzz,
    ) = covariance
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
    ptxx = nxx
    ptxy = nxy
    ptxz = nxz
    ptyx = nyx
    ptyy = nyy
    ptyz = nyz
    ptzx = nzx
    ptzy = nzy
    ptzz = nzz
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
    vtxx = wxx
    vtxy = wxy
    vtxz = wxz
    vtyx = wyx
    vtyy = wyy
    vtyz = wyz
    vtzx = wzx
    vtzy = wzy
    vtzz = wzz
    ttxx += q_tt
    ttyy += q_tt
    ttzz += q_tt
    return (
        ppxx, ppxy, ppxz, ppyy, ppyz, ppzz,
        pvxx, pvxy, pvxz, pvyx, pvyy, pvyz, pvzx, pvzy, pvzz,
        ptxx, ptxy, ptxz, ptyx, ptyy, ptyz, ptzx, ptzy, ptzz,
        vvxx, vvxy, vvxz, vvyy, vvyz, vvzz,
        vtxx, vtxy, vtxz, vtyx, vtyy, vtyz, vtzx, vtzy, vtzz,
        ttxx, ttxy, ttxz, ttyy, ttyz, ttzz,
    )


def update(
    covariance: Covariance, zx: float, zy: float, zz: float, r: float, limit: float
) -> tuple[Covariance, Correction] | None:
    """Correct by a velocity error z = measured - estimated (m/s) with variance r (m^2/s^2) on each axis.

    Returns the new P and the corrections of the nine states, or None when z is so unlikely that its normalised
    square exceeds `limit` (then the measurement is not of this velocity).
    """
    (
        ppxx, ppxy, ppxz, ppyy, ppyz, ppzz,
        pvxx, pvxy, pvxz, pvyx, pvyy, pvyz, pvzx, pvzy, pvzz,
        ptxx, ptxy, ptxz, ptyx, ptyy, ptyz, ptzx, ptzy, ptzz,
        vvxx, vvxy, vvxz, vvyy, vvyz, vvzz,
        vtxx, vtxy, vtxz, vtyx, vtyy, vtyz, vtzx, vtzy, vtzz,
        ttxx, ttxy, ttxz, ttyy, ttyz, ttzz,
    ) = covariance
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
    # the rows of P H', kept before P changes; corrections P H' w; gains K = P H' S^-1
    hpxx, hpxy, hpxz = pvxx, pvxy, pvxz
    hpyx, hpyy, hpyz = pvyx, pvyy, pvyz
    hpzx, hpzy, hpzz = pvzx, pvzy, pvzz
    hvxx, hvxy, hvxz = vvxx, vvxy, vvxz
    hvyx, hvyy, hvyz = vvxy, vvyy, vvyz
    hvzx, hvzy, hvzz = vvxz, vvyz, vvzz
    htxx, htxy, htxz = vtxx, vtyx, vtzx
    htyx, htyy, htyz = vtxy, vtyy, vtzy
    htzx, htzy, htzz = vtxz, vtyz, vtzz
    kpxx = hpxx * ixx + hpxy * ixy + hpxz * ixz
    kpxy = hpxx * ixy + hpxy * iyy + hpxz * iyz
    kpxz = hpxx * ixz + hpxy * iyz + hpxz * izz
    kpyx = hpyx * ixx + hpyy * ixy + hpyz * ixz
    kpyy = hpyx * ixy + hpyy * iyy + hpyz * iyz
    kpyz = hpyx * ixz + hpyy * iyz + hpyz * izz
    kpzx = hpzx * ixx + hpzy * ixy + hpzz * ixz
    kpzy = hpzx * ixy + hpzy * iyy + hpzz * iyz
    kpzz = hpzx * ixz + hpzy * iyz + hpzz * izz
    kvxx = hvxx * ixx + hvxy * ixy + hvxz * ixz
    kvxy = hvxx * ixy + hvxy * iyy + hvxz * iyz
    kvxz = hvxx * ixz + hvxy * iyz + hvxz * izz
    kvyx = hvyx * ixx + hvyy * ixy + hvyz * ixz
    kvyy = hvyx * ixy + hvyy * iyy + hvyz * iyz
    kvyz = hvyx * ixz + hvyy * iyz + hvyz * izz
    kvzx = hvzx * ixx + hvzy * ixy + hvzz * ixz
    kvzy = hvzx * ixy + hvzy * iyy + hvzz * iyz
    kvzz = hvzx * ixz + hvzy * iyz + hvzz * izz
    ktxx = htxx * ixx + htxy * ixy + htxz * ixz
    ktxy = htxx * ixy + htxy * iyy + htxz * iyz
    ktxz = htxx * ixz + htxy * iyz + htxz * izz
    ktyx = htyx * ixx + htyy * ixy + htyz * ixz
    ktyy = htyx * ixy + htyy * iyy + htyz * iyz
    ktyz = htyx * ixz + htyy * iyz + htyz * izz
    ktzx = htzx * ixx + htzy * ixy + htzz * ixz
    ktzy = htzx * ixy + htzy * iyy + htzz * iyz
    ktzz = htzx * ixz + htzy * iyz + htzz * izz
    # P <- P - K H P
    ppxx -= kpxx * hpxx + kpxy * hpxy + kpxz * hpxz
    ppxy -= kpxx * hpyx + kpxy * hpyy + kpxz * hpyz
    ppxz -= kpxx * hpzx + kpxy * hpzy + kpxz * hpzz
    pvxx -= kpxx * hvxx + kpxy * hvxy + kpxz * hvxz
    pvxy -= kpxx * hvyx + kpxy * hvyy + kpxz * hvyz
    pvxz -= kpxx * hvzx + kpxy * hvzy + kpxz * hvzz
    ptxx -= kpxx * htxx + kpxy * htxy + kpxz * htxz
    ptxy -= kpxx * htyx + kpxy * htyy + kpxz * htyz
    ptxz -= kpxx * htzx + kpxy * htzy + kpxz * htzz
    ppyy -= kpyx * hpyx + kpyy * hpyy + kpyz * hpyz
    ppyz -= kpyx * hpzx + kpyy * hpzy + kpyz * hpzz
    pvyx -= kpyx * hvxx + kpyy * hvxy + kpyz * hvxz
    pvyy -= kpyx * hvyx + kpyy * hvyy + kpyz * hvyz
    pvyz -= kpyx * hvzx + kpyy * hvzy + kpyz * hvzz
    ptyx -= kpyx * htxx + kpyy * htxy + kpyz * htxz
    ptyy -= kpyx * htyx + kpyy * htyy + kpyz * htyz
    ptyz -= kpyx * htzx + kpyy * htzy + kpyz * htzz
    ppzz -= kpzx * hpzx + kpzy * hpzy + kpzz * hpzz
    pvzx -= kpzx * hvxx + kpzy * hvxy + kpzz * hvxz
    pvzy -= kpzx * hvyx + kpzy * hvyy + kpzz * hvyz
    pvzz -= kpzx * hvzx + kpzy * hvzy + kpzz * hvzz
    ptzx -= kpzx * htxx + kpzy * htxy + kpzz * htxz
    ptzy -= kpzx * htyx + kpzy * htyy + kpzz * htyz
    ptzz -= kpzx * htzx + kpzy * htzy + kpzz * htzz
    vvxx -= kvxx * hvxx + kvxy * hvxy + kvxz * hvxz
    vvxy -= kvxx * hvyx + kvxy * hvyy + kvxz * hvyz
    vvxz -= kvxx * hvzx + kvxy * hvzy + kvxz * hvzz
    vtxx -= kvxx * htxx + kvxy * htxy + kvxz * htxz
    vtxy -= kvxx * htyx + kvxy * htyy + kvxz * htyz
    vtxz -= kvxx * htzx + kvxy * htzy + kvxz * htzz
    vvyy -= kvyx * hvyx + kvyy * hvyy + kvyz * hvyz
    vvyz -= kvyx * hvzx + kvyy * hvzy + kvyz * hvzz
    vtyx -= kvyx * htxx + kvyy * htxy + kvyz * htxz
    vtyy -= kvyx * htyx + kvyy * htyy + kvyz * htyz
    vtyz -= kvyx * htzx + kvyy * htzy + kvyz * htzz
    vvzz -= kvzx * hvzx + kvzy * hvzy + kvzz * hvzz
    vtzx -= kvzx * htxx + kvzy * htxy + kvzz * htxz
    vtzy -= kvzx * htyx + kvzy * htyy + kvzz * htyz
    vtzz -= kvzx * htzx + kvzy * htzy + kvzz * htzz
    ttxx -= ktxx * htxx + ktxy * htxy + ktxz * htxz
    ttxy -= ktxx * htyx + ktxy * htyy + ktxz * htyz
    ttxz -= ktxx * htzx + ktxy * htzy + ktxz * htzz
    ttyy -= ktyx * htyx + ktyy * htyy + ktyz * htyz
    ttyz -= ktyx * htzx + ktyy * htzy + ktyz * htzz
    ttzz -= ktzx * htzx + ktzy * htzy + ktzz * htzz
    return (
        (
            ppxx, ppxy, ppxz, ppyy, ppyz, ppzz,
            pvxx, pvxy, pvxz, pvyx, pvyy, pvyz, pvzx, pvzy, pvzz,
            ptxx, ptxy, ptxz, ptyx, ptyy, ptyz, ptzx, ptzy, ptzz,
            vvxx, vvxy, vvxz, vvyy, vvyz, vvzz,
            vtxx, vtxy, vtxz, vtyx, vtyy, vtyz, vtzx, vtzy, vtzz,
            ttxx, ttxy, ttxz, ttyy, ttyz, ttzz,
        ),
        (
            hpxx * wx + hpxy * wy + hpxz * wz,
            hpyx * wx + hpyy * wy + hpyz * wz,
            hpzx * wx + hpzy * wy + hpzz * wz,
            hvxx * wx + hvxy * wy + hvxz * wz,
            hvyx * wx + hvyy * wy + hvyz * wz,
            hvzx * wx + hvzy * wy + hvzz * wz,
            htxx * wx + htxy * wy + htxz * wz,
            htyx * wx + htyy * wy + htyz * wz,
            htzx * wx + htzy * wy + htzz * wz,
        ),
    )


def believed_height(covariance: Covariance, left: float) -> Covariance:
    """The height is known from elsewhere, with `left` (0 to 1) of its variance: P <- D P D, D = diag(1, 1, d, 1, ...)
    with d^2 = `left`. What else is uncertain stays so, and has less to do with the height."""
    d = sqrt(left)
    p = list(covariance)
    p[HEIGHT] *= left
    for i in (2, 4, 12, 13, 14, 21, 22, 23):  # ppxz, ppyz, pvz, ptz
        p[i] *= d
    return tuple(p)
