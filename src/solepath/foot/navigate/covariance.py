"""The covariance of the nine error states, in straight-line scalar code.

States: dp (position, m), dv (velocity, m/s), dt (attitude, rad, small turn in the world frame: R_true = exp([dt]x) R).
`Covariance` holds the upper triangle of the symmetric 9x9 matrix, block by block: pp (6), pv (9), pt (9), vv (6),
vt (9), tt (6); the names say which states meet, so `vtxz` is the covariance of dv_x and dt_z.

Between two corrections nobody needs the covariance, so it is carried over the whole interval T at once. With
S = integral of f dt and D = double integral of f dt^2 (f: specific force in the world frame), and the attitude error
constant over T, the error equations dp' = dv, dv' = -[f]x dt (Sola 2017, section 7) integrate exactly to

    dp(T) = dp + T dv + M2 dt,  M2 = -[D]x      dv(T) = dv + M1 dt,  M1 = -[S]x      dt(T) = dt

The lines below are the blocks of P <- F P F' + Q, those of the update by a measured velocity are in update.py;
tests/foot/test_covariance.py holds both against the matrix form.
"""

from __future__ import annotations

Covariance = tuple[float, ...]
"""45 numbers: pp, pv, pt, vv, vt, tt."""

Correction = tuple[float, float, float, float, float, float, float, float, float]
"""What to add to dp, dv and dt: m, m/s, rad."""

PLACE_X, PLACE_Y, HEIGHT = 0, 3, 5
"""Where the variances of the position stand in a Covariance."""
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
        ppxx,
        ppxy,
        ppxz,
        ppyy,
        ppyz,
        ppzz,
        pvxx,
        pvxy,
        pvxz,
        pvyx,
        pvyy,
        pvyz,
        pvzx,
        pvzy,
        pvzz,
        ptxx,
        ptxy,
        ptxz,
        ptyx,
        ptyy,
        ptyz,
        ptzx,
        ptzy,
        ptzz,
        vvxx,
        vvxy,
        vvxz,
        vvyy,
        vvyz,
        vvzz,
        vtxx,
        vtxy,
        vtxz,
        vtyx,
        vtyy,
        vtyz,
        vtzx,
        vtzy,
        vtzz,
        ttxx,
        ttxy,
        ttxz,
        ttyy,
        ttyz,
        ttzz,
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
        ppxx,
        ppxy,
        ppxz,
        ppyy,
        ppyz,
        ppzz,
        pvxx,
        pvxy,
        pvxz,
        pvyx,
        pvyy,
        pvyz,
        pvzx,
        pvzy,
        pvzz,
        ptxx,
        ptxy,
        ptxz,
        ptyx,
        ptyy,
        ptyz,
        ptzx,
        ptzy,
        ptzz,
        vvxx,
        vvxy,
        vvxz,
        vvyy,
        vvyz,
        vvzz,
        vtxx,
        vtxy,
        vtxz,
        vtyx,
        vtyy,
        vtyz,
        vtzx,
        vtzy,
        vtzz,
        ttxx,
        ttxy,
        ttxz,
        ttyy,
        ttyz,
        ttzz,
    )
