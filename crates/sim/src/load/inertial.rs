//! The inertia of one link, and whether it is that of a body.

use super::pose::rotation;
use super::tree::LinkElement;
use crate::error::{Error, ErrorKind, Warning};
use gyroflex::spatial::{SpatialInertia, SymMat3, Vec3};
use nalgebra::Matrix3;

/// Rounding that files with few digits carry, as part of the largest principal moment.
const ROUNDING: f64 = 1e-6;

/// The inertia of a link about the origin of its frame. `matters` is false for links that do not move.
pub(crate) fn inertia(
    link: &LinkElement,
    matters: bool,
    warnings: &mut Vec<Warning>,
) -> Result<SpatialInertia<f64>, Error> {
    let Some(inertial) = &link.inertial else { return Ok(SpatialInertia::zero()) };
    let (mass, i) = (inertial.mass.value, &inertial.inertia);
    let about_com = SymMat3 { xx: i.ixx, yy: i.iyy, zz: i.izz, xy: i.ixy, xz: i.ixz, yz: i.iyz };
    if matters {
        let fault = |problem: String, remedy: &str| Error {
            kind: ErrorKind::Model,
            file: link.at.clone(),
            element: format!("link `{}`", link.name),
            problem,
            remedy: remedy.to_owned(),
        };
        if mass < 0.0 {
            return Err(fault(
                format!("its mass is negative: {mass} kg"),
                "give its mass, or 0 for a frame without mass",
            ));
        }
        let [least, middle, most] = principal_moments(&about_com);
        if least < -ROUNDING * most.abs() {
            return Err(fault(
                format!("its inertia has a negative principal moment ({least:.6e}, {middle:.6e}, {most:.6e} kg m²)"),
                "check the signs of the products of inertia, and that the inertia is about the centre of mass",
            ));
        }
        if least + middle < most * (1.0 - ROUNDING) {
            warnings.push(Warning {
                file: link.at.clone(),
                element: format!("link `{}`", link.name),
                message: format!(
                    "its principal moments {least:.6e}, {middle:.6e}, {most:.6e} kg m² violate the triangle inequality: \
                     no distribution of mass has them; used as they are, since the equations of motion stay well posed"
                ),
            });
        }
    }
    let r = rotation(inertial.origin.rpy.0);
    let com = Vec3::from(inertial.origin.xyz.0);
    Ok(SpatialInertia::from_com(mass, com, about_com.congruence(r.transpose())))
}

/// Principal moments from the least to the largest [kg m²].
fn principal_moments(a: &SymMat3<f64>) -> [f64; 3] {
    let m = Matrix3::new(a.xx, a.xy, a.xz, a.xy, a.yy, a.yz, a.xz, a.yz, a.zz);
    let e = m.symmetric_eigenvalues();
    let mut moments = [e[0], e[1], e[2]];
    moments.sort_by(f64::total_cmp);
    moments
}
