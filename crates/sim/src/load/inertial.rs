//! The inertia of one link, and whether bodies have such inertias.

use super::pose::rotation;
use super::tree::LinkElement;
use crate::error::{Error, ErrorKind, Warning};
use gyroflex::spatial::{SpatialInertia, SymMat3, Vec3};
use nalgebra::Matrix3;

/// Rounding that files with few digits carry, as part of the largest principal moment.
const ROUNDING: f64 = 1e-6;
/// Moments this small are rounding whatever stands beside them: a gram a micrometre away [kg m²].
const NOTHING: f64 = 1e-15;

/// The inertia of a link about the origin of its frame.
pub(crate) fn inertia(link: &LinkElement) -> SpatialInertia<f64> {
    let Some(inertial) = &link.inertial else { return SpatialInertia::zero() };
    let r = rotation(inertial.origin.rpy.0);
    let com = Vec3::from(inertial.origin.xyz.0);
    SpatialInertia::from_com(inertial.mass.value, com, about_com(inertial).congruence(r.transpose()))
}

/// Judges the own inertia of a link that is part of the moving `body`.
///
/// A negative moment is an error unless other links fused to this one make up for it: forward dynamics could divide by
/// zero. The triangle inequality only tells that no distribution of mass has these moments; the equations of motion stay
/// well posed, and published models that violate it are many, so that it is a warning.
pub(crate) fn check(link: &LinkElement, body: &SpatialInertia<f64>, warnings: &mut Vec<Warning>) -> Result<(), Error> {
    let Some(inertial) = &link.inertial else { return Ok(()) };
    let element = format!("link `{}`", link.name);
    let fault = |problem: String, remedy: &str| Error {
        kind: ErrorKind::Model,
        file: link.at.clone(),
        element: element.clone(),
        problem,
        remedy: remedy.to_owned(),
    };
    let mass = inertial.mass.value;
    if mass < 0.0 {
        return Err(fault(format!("its mass is negative: {mass} kg"), "give its mass, or 0 for a frame without mass"));
    }
    let moments @ [least, middle, most] = principal_moments(&about_com(inertial));
    let named = format!("{least:.6e}, {middle:.6e}, {most:.6e} kg m²");
    let mut warn = |message: String| {
        warnings.push(Warning { file: link.at.clone(), element: element.clone(), message });
    };
    if is_negative(moments) {
        if is_negative(principal_moments(&about_own_com(body))) {
            return Err(fault(
                format!("its inertia has a negative principal moment ({named})"),
                "check the signs of the products of inertia, and that the inertia is about the centre of mass",
            ));
        }
        warn(format!(
            "its inertia has a negative principal moment ({named}); used as it is, since the links on fixed joints around it \
             make up for it"
        ));
    } else if breaks_triangle(moments) {
        warn(format!(
            "its principal moments ({named}) violate the triangle inequality: no distribution of mass has them; \
             used as they are, since the equations of motion stay well posed"
        ));
    }
    Ok(())
}

/// What keeps a rotational inertia about the centre of mass from being that of a body; `None` where nothing does.
pub(crate) fn unphysical(about_com: &SymMat3<f64>) -> Option<String> {
    let moments @ [least, middle, most] = principal_moments(about_com);
    let named = format!("{least:.6e}, {middle:.6e}, {most:.6e} kg m²");
    if is_negative(moments) {
        return Some(format!("it has a negative principal moment ({named})"));
    }
    breaks_triangle(moments).then(|| {
        format!("its principal moments ({named}) violate the triangle inequality: no distribution of mass has them")
    })
}

fn about_com(inertial: &urdf_rs::Inertial) -> SymMat3<f64> {
    let i = &inertial.inertia;
    SymMat3 { xx: i.ixx, yy: i.iyy, zz: i.izz, xy: i.ixy, xz: i.ixz, yz: i.iyz }
}

/// The rotational inertia of a body about its own centre of mass.
fn about_own_com(body: &SpatialInertia<f64>) -> SymMat3<f64> {
    if body.mass == 0.0 {
        return body.rotational;
    }
    let com = body.first_moment.scale(1.0 / body.mass);
    body.rotational - SpatialInertia::from_com(body.mass, com, SymMat3::zero()).rotational
}

fn is_negative([least, _, most]: [f64; 3]) -> bool {
    least < -ROUNDING * most.abs() - NOTHING
}

fn breaks_triangle([least, middle, most]: [f64; 3]) -> bool {
    least + middle < most * (1.0 - ROUNDING) - NOTHING
}

/// Principal moments from the least to the largest [kg m²].
fn principal_moments(a: &SymMat3<f64>) -> [f64; 3] {
    let m = Matrix3::new(a.xx, a.xy, a.xz, a.xy, a.yy, a.yz, a.xz, a.yz, a.zz);
    let e = m.symmetric_eigenvalues();
    let mut moments = [e[0], e[1], e[2]];
    moments.sort_by(f64::total_cmp);
    moments
}
