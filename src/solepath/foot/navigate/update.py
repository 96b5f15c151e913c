"""What a measured velocity, or a height that is known, makes of the covariance, in straight-line scalar code.

The lines below are the blocks of the Kalman update with H = [0 I 0]; states and names are those of covariance.py.
"""

from __future__ import annotations

from math import sqrt

from .covariance import HEIGHT, Correction, Covariance


def update(
    covariance: Covariance, zx: float, zy: float, zz: float, r: float, limit: float
) -> tuple[Covariance, Correction] | None:
    """Correct by a velocity error z = measured - estimated (m/s) with variance r (m^2/s^2) on each axis.

    Returns the new P and the corrections of the nine states, or None when z is so unlikely that its normalised
    square exceeds `limit` (then the measurement is not of this velocity).
    """
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
    # gains K = P H' S^-1; of P H' the rows are pv, vv and vt transposed
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
            ppxx,
            ppxy,
            ppxz,
            ppyy,
            ppyz,
            ppzz,
            # P H' - K H P H' = K (S - H P H') = K r: of the velocity's columns r K is left
            r * kpxx,
            r * kpxy,
            r * kpxz,
            r * kpyx,
            r * kpyy,
            r * kpyz,
            r * kpzx,
            r * kpzy,
            r * kpzz,
            ptxx,
            ptxy,
            ptxz,
            ptyx,
            ptyy,
            ptyz,
            ptzx,
            ptzy,
            ptzz,
            r * kvxx,
            r * kvxy,
            r * kvxz,
            r * kvyy,
            r * kvyz,
            r * kvzz,
            r * ktxx,
            r * ktyx,
            r * ktzx,
            r * ktxy,
            r * ktyy,
            r * ktzy,
            r * ktxz,
            r * ktyz,
            r * ktzz,
            ttxx,
            ttxy,
            ttxz,
            ttyy,
            ttyz,
            ttzz,
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
