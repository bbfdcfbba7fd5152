//! What an articulated body with a free joint shows to its parent.

use super::{ArticulatedInertia, Force, JointTransform, Mat3, SymMat3, Vec3};
use crate::Scalar;

/// `Iᵃ = Iᴬ − U Uᵀ/d` for a joint about z that nothing drives rigidly: no moment about z passes it, so the third row and
/// column of the angular block and the third row of the mixed block are zero (RBDA eq. 7.30 and the remark below it).
#[derive(Clone, Copy, Debug)]
pub struct ReleasedInertia<T> {
    /// Entries (1, 1), (2, 2) and (1, 2) of the angular block [kg m²].
    ang: [T; 3],
    /// First two rows of the mixed block [kg m].
    mixed: [Vec3<T>; 2],
    /// Linear block [kg].
    lin: SymMat3<T>,
}

impl<T: Scalar> ArticulatedInertia<T> {
    /// `Iᴬ − U Uᵀ/d`, where `U = Iᴬ e_z` and `d` is its component along z; `d_inv` is `1/d`.
    #[inline(always)]
    pub fn released_about_z(&self, d_inv: T) -> ReleasedInertia<T> {
        // Of Uᵀ = (I_xz, I_yz, d, H_zx, H_zy, H_zz), the first two by all of U/d.
        let (u, [hx, hy, h]) = (self.ang, self.mixed.rows);
        let (sx, sy, s) = (-(u.xz * d_inv), -(u.yz * d_inv), h.scale(-d_inv));
        ReleasedInertia {
            ang: [sx.mul_add(u.xz, u.xx), sy.mul_add(u.yz, u.yy), sx.mul_add(u.yz, u.xy)],
            mixed: [hx.plus_scaled(sx, h), hy.plus_scaled(sy, h)],
            lin: SymMat3 {
                xx: s.x.mul_add(h.x, self.lin.xx),
                yy: s.y.mul_add(h.y, self.lin.yy),
                zz: s.z.mul_add(h.z, self.lin.zz),
                xy: s.x.mul_add(h.y, self.lin.xy),
                xz: s.x.mul_add(h.z, self.lin.xz),
                yz: s.y.mul_add(h.z, self.lin.yz),
            },
        }
    }
}

impl<T: Scalar> ReleasedInertia<T> {
    /// `Iᵃ c` for an acceleration without an angular part along z.
    #[inline(always)]
    pub fn force(&self, ang: [T; 2], lin: Vec3<T>) -> Force<T> {
        let ([xx, yy, xy], [hx, hy], [ax, ay]) = (self.ang, self.mixed, ang);
        Force {
            ang: Vec3::new(
                xx.mul_add(ax, xy.mul_add(ay, hx.dot(lin))),
                xy.mul_add(ax, yy.mul_add(ay, hy.dot(lin))),
                T::zero(),
            ),
            lin: (self.lin * lin).plus_scaled(ax, hx).plus_scaled(ay, hy),
        }
    }

    /// `Xᵀ Iᵃ X`: seen from the parent.
    #[inline(always)]
    pub fn seen_from_parent(&self, x: &JointTransform<T>) -> ArticulatedInertia<T> {
        // Rz(θ)ᵀ Iᵃ Rz(θ) leaves the zeros where they are.
        let theta = x.theta;
        let (xx, yy, xy) = theta.sym_back(self.ang[0], self.ang[1], self.ang[2]);
        let [a, b] = self.mixed;
        let [[hxx, hxy], [hyx, hyy]] = theta.mat_back([[a.x, a.y], [b.x, b.y]]);
        let (hxz, hyz) = theta.pair_back(a.z, b.z);
        let lin = theta.z_back_sym(self.lin);
        // Along z by d, the same.
        let d = x.d;
        let (gxx, gxy, gxz) = ((-d).mul_add(lin.xy, hxx), (-d).mul_add(lin.yy, hxy), (-d).mul_add(lin.yz, hxz));
        let (gyx, gyy, gyz) = (d.mul_add(lin.xx, hyx), d.mul_add(lin.xy, hyy), d.mul_add(lin.xz, hyz));
        let xx = (-d).mul_add(gxy + hxy, xx);
        let yy = d.mul_add(gyx + hyx, yy);
        let xy = d.mul_add(hxx - gyy, xy);
        // Rx(α)ᵀ · Rx(α), with zeros in the third row.
        let (s, c) = (x.alpha.sin, x.alpha.cos);
        let ys = yy * s;
        let ang = SymMat3 { xx, yy: (-s).mul_add(ys, yy), zz: s * ys, xy: c * xy, xz: s * xy, yz: c * ys };
        let (xy, xz) = x.alpha.pair_back(gxy, gxz);
        let (yy, yz) = x.alpha.pair_back(gyy, gyz);
        let mixed = Mat3::from_rows(
            Vec3::new(gxx, xy, xz),
            Vec3::new(c * gyx, c * yy, c * yz),
            Vec3::new(s * gyx, s * yy, s * yz),
        );
        // Along x by a.
        ArticulatedInertia { ang, mixed, lin: x.alpha.x_back_sym(lin) }.moved_along_x(x.a)
    }
}
