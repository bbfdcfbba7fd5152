//! Robots of the project, their numbers by hand: code generation does not read files.

use super::Arm;
use gyroflex::model::{
    BodySpec, DriveSpec, Fidelity, Friction, JointKind, MountSpec, RotorBody, RotorSpec, SpringSpec, TransmissionError,
    TransmissionSpec,
};
use gyroflex::spatial::{Mat3, SpatialInertia, SymMat3, Transform, Vec3};
use gyroflex_codegen::weigh::Motion;
use gyroflex_testkit::flexible::{BendingLink, Particle, Seats, Section, Shapes};
use gyroflex_testkit::random::{RandomFlexible, RandomRobot};
use nalgebra::DMatrix;

const Z: Vec3<f64> = Vec3 { x: 0.0, y: 0.0, z: 1.0 };

fn pose(xyz: [f64; 3], roll: f64) -> Transform<f64> {
    Transform::from_pose(Mat3::from_rpy(roll, 0.0, 0.0), xyz.into())
}

fn elastic(stiffness: f64, damping: f64) -> TransmissionSpec {
    let spring = SpringSpec::Polynomial { stiffness, cubic: 0.0 };
    TransmissionSpec::Elastic { spring, damping, error: TransmissionError::none() }
}

/// The PUMA 560 of `robots/puma560`; `rotor` scales the inertia of its rotors.
pub fn puma560(fidelity: Fidelity, rotor: f64) -> Arm {
    const QUARTER: f64 = core::f64::consts::FRAC_PI_2;
    type Link = ([f64; 3], f64, [f64; 3], f64, f64, [f64; 3]);
    // Joint: place, roll. Link: centre of mass, roll of its axes, mass, moments.
    let links: [Link; 6] = [
        ([0.0, 0.0, 0.0], 0.0, [0.0, 0.0, 0.67183], QUARTER, 13.0, [0.2, 0.35, 0.2]),
        ([0.0, 0.0, 0.67183], QUARTER, [0.068, 0.006, 0.2275], 0.0, 17.4, [0.13, 0.524, 0.539]),
        ([0.4318, 0.0, 0.0], 0.0, [0.0, 0.070, 0.16415], -QUARTER, 4.8, [0.066, 0.086, 0.0125]),
        ([0.0203, 0.0, 0.15005], -QUARTER, [0.0, 0.0, 0.4508], QUARTER, 0.82, [0.0018, 0.0013, 0.0018]),
        ([0.0, 0.0, 0.4318], QUARTER, [0.0; 3], -QUARTER, 0.34, [0.0003, 0.0004, 0.0003]),
        ([0.0, 0.0, 0.0], -QUARTER, [0.0, 0.0, 0.032], 0.0, 0.09, [0.00015, 0.00015, 0.00004]),
    ];
    // J, N, K, D
    let drives = [
        (2.0e-4, -62.6111, 4.0e4, 40.0),
        (2.0e-4, 107.815, 3.0e4, 30.0),
        (2.0e-4, -53.7063, 1.2e4, 6.5),
        (3.3e-5, 76.0364, 1500.0, 0.16),
        (3.3e-5, 71.923, 1000.0, 0.08),
        (3.3e-5, 76.686, 500.0, 0.014),
    ];
    let bodies = links.iter().zip(drives).enumerate().map(|(i, (link, (inertia, gear_ratio, k, d)))| {
        let &(at, roll, com, turned, mass, [xx, yy, zz]) = link;
        let about_com = Transform::from_pose(Mat3::from_rpy(turned, 0.0, 0.0), Vec3::zero())
            .inv_tensor(SymMat3::diagonal(xx, yy, zz));
        // Wrist motors sit in the forearm and point along it.
        let mount = match i {
            0 => MountSpec { body: None, placement: pose(at, roll), axis: Z },
            1 | 2 => MountSpec { body: Some(i - 1), placement: pose(at, roll), axis: Z },
            _ => MountSpec { body: Some(2), placement: Transform::identity(), axis: Vec3::new(0.0, 1.0, 0.0) },
        };
        BodySpec {
            parent: i.checked_sub(1),
            joint: JointKind::Revolute,
            axis: Z,
            placement: pose(at, roll),
            inertia: SpatialInertia::from_com(mass, com.into(), about_com),
            friction: Friction::none(),
            drive: Some(DriveSpec {
                rotor: RotorSpec { inertia: rotor * inertia, body: None, mount },
                gear_ratio,
                transmission: elastic(k, d),
                friction: Friction::none(),
            }),
        }
    });
    named("puma560", bodies.collect(), [0.0, 0.0, -9.81], fidelity)
}

/// A planar arm of two links in a vertical plane with elastic joints, the second motor on the first link.
pub fn planar_2r(fidelity: Fidelity) -> Arm {
    let (length, mass) = ([0.5, 0.4], [4.0, 2.5]);
    let drives = [(2.0e-4, 100.0, 6.0e3, 4.0), (1.0e-4, 80.0, 3.0e3, 2.0)];
    let bodies = (0..2).map(|i| {
        let (inertia, gear_ratio, k, d) = drives[i];
        let at = if i == 0 { Vec3::zero() } else { Vec3::new(length[0], 0.0, 0.0) };
        let across = mass[i] * length[i] * length[i] / 12.0;
        let com = Vec3::new(length[i] / 2.0, 0.0, 0.0);
        let placement = Transform::from_pose(Mat3::identity(), at);
        BodySpec {
            parent: i.checked_sub(1),
            joint: JointKind::Revolute,
            axis: Z,
            placement,
            inertia: SpatialInertia::from_com(mass[i], com, SymMat3::diagonal(1e-3, across, across)),
            friction: Friction::none(),
            drive: Some(DriveSpec {
                rotor: RotorSpec {
                    inertia,
                    body: Some(RotorBody { mass: 0.4, transverse_inertia: inertia }),
                    mount: MountSpec { body: i.checked_sub(1), placement, axis: Z },
                },
                gear_ratio,
                transmission: elastic(k, d),
                friction: Friction::viscous(1e-4),
            }),
        }
    });
    named("planar_2r", bodies.collect(), [0.0, -9.81, 0.0], fidelity)
}

fn named(name: &str, bodies: Vec<BodySpec>, gravity: [f64; 3], fidelity: Fidelity) -> Arm {
    let robot = RandomRobot { seed: 0, bodies, spring_tables: Vec::new(), gravity: gravity.into() };
    Arm { name: name.to_owned(), ..Arm::of(robot, fidelity) }
}

/// The two-link arm of Cetinkunt and Book, `robots/book_two_link`: two clamped-free modes a link. With `elastic_joints` it is that of
/// `elastic.yaml`.
pub fn two_link(elastic_joints: bool) -> Arm {
    let (length, mass, rigidity) = (1.0, 0.5, 10.0);
    let place =
        |i: usize| Transform::from_pose(Mat3::identity(), Vec3::new(if i == 0 { 0.0 } else { length }, 0.0, 0.0));
    let drives = [(400.0, 0.4, 0.0), (200.0, 0.2, 0.2)];
    let link = |body: usize| {
        let carried = if body == 0 && elastic_joints { drives[1].2 } else { 0.0 };
        beam(body, length, mass, rigidity, carried)
    };
    let links = vec![link(0), link(1)];
    let whole = |link: &BendingLink| {
        let at_rest = |p: &Particle| SpatialInertia::from_com(p.mass, p.at, SymMat3::zero());
        let lumps = link.sections.iter().map(|s| s.lump);
        link.cloud.iter().map(at_rest).chain(lumps).fold(SpatialInertia::zero(), |sum, part| sum + part)
    };
    let bodies: Vec<BodySpec> = links
        .iter()
        .enumerate()
        .map(|(i, link)| BodySpec {
            parent: i.checked_sub(1),
            joint: JointKind::Revolute,
            axis: Z,
            placement: place(i),
            inertia: whole(link),
            friction: Friction::none(),
            drive: elastic_joints.then(|| DriveSpec {
                rotor: RotorSpec {
                    inertia: 2e-5,
                    body: None,
                    mount: MountSpec { body: None, placement: Transform::identity(), axis: Z },
                },
                gear_ratio: 100.0,
                transmission: elastic(drives[i].0, drives[i].1),
                friction: Friction::none(),
            }),
        })
        .collect();
    let mut robot = RandomRobot { seed: 0, bodies, spring_tables: Vec::new(), gravity: [0.0, 0.0, -9.81].into() };
    if let Some(drive) = robot.bodies[1].drive.as_mut() {
        drive.rotor.mount = MountSpec { body: Some(0), placement: place(1), axis: Z };
        // Its spin is part of what it sits on.
    }
    let mut links = links;
    if elastic_joints {
        let own = SymMat3::outer(Z).scale(2e-5);
        links[0].sections[0].lump.rotational += own;
        robot.bodies[0].inertia.rotational += own;
    }
    let seats = vec![Seats::default(), Seats { joint: Some(0), rotor: elastic_joints.then_some(0) }];
    let random = RandomFlexible { robot, links, seats };
    let mut arm = Arm::of_bending(random, Fidelity::Complete);
    arm.name = "book_two_link".to_owned();
    arm.links = vec!["upper".to_owned(), "lower".to_owned()];
    arm
}

/// A slender link that bends in its plane in the first two eigenfunctions of a beam clamped at its root, normalised so that the modal
/// mass is that of the beam; its mass in so many points that integrals over it are exact to many digits.
fn beam(body: usize, length: f64, mass: f64, rigidity: f64, at_tip: f64) -> BendingLink {
    const PIECES: usize = 200;
    // Roots of cosh λ cos λ = −1.
    let roots: [f64; 2] = [1.875_104_068_711_961, 4.694_091_132_974_175];
    let shape = |j: usize, x: f64| {
        let l = roots[j];
        let sigma = (l.sinh() - l.sin()) / (l.cosh() + l.cos());
        let z = l * x / length;
        let value = z.cosh() - z.cos() - sigma * (z.sinh() - z.sin());
        let slope = l / length * (z.sinh() + z.sin() - sigma * (z.cosh() - z.cos()));
        [value, slope]
    };
    let shapes = |x: f64| Shapes {
        displacement: (0..2).map(|j| Vec3::new(0.0, shape(j, x)[0], 0.0)).collect(),
        shortening: Vec::new(),
    };
    // Two points of Gauss a piece.
    let piece = length / PIECES as f64;
    let points = (0..2 * PIECES).map(|k| {
        let off = if k % 2 == 0 { -1.0 } else { 1.0 } / 3.0_f64.sqrt();
        ((k / 2) as f64 + 0.5 + 0.5 * off) * piece
    });
    let particle =
        |x: f64| Particle { mass: mass / (2 * PIECES) as f64, at: Vec3::new(x, 0.0, 0.0), shapes: shapes(x) };
    let tip = Vec3::new(length, 0.0, 0.0);
    BendingLink {
        body,
        hub: SpatialInertia::zero(),
        cloud: points.map(particle).collect(),
        sections: vec![Section {
            at: tip,
            shapes: shapes(length),
            turns: (0..2).map(|j| Z.scale(shape(j, length)[1])).collect(),
            lump: SpatialInertia::from_com(at_tip, tip, SymMat3::zero()),
        }],
        stiffness: DMatrix::from_fn(
            2,
            2,
            |j, k| {
                if j == k { rigidity * roots[j].powi(4) / length.powi(3) } else { 0.0 }
            },
        ),
        damping: DMatrix::zeros(2, 2),
        stiffening: false,
    }
}

/// Sines through the working space of an arm, of joints that are stiff: motors go along.
pub fn waves(arm: &Arm, count: usize) -> Vec<Motion> {
    let n = arm.robot().nv();
    (0..count)
        .map(|sample| {
            let time = 4.0 * sample as f64 / count as f64;
            let wave = |order: i32| -> Vec<f64> {
                (0..n)
                    .map(|i| {
                        let (size, speed) = if i < arm.random.bodies.len() { (1.2, 2.0) } else { (0.01, 9.0) };
                        let (speed, start) = (speed * (1.0 + 0.13 * i as f64), 0.9 * i as f64);
                        size * speed.powi(order)
                            * (speed * time + start + f64::from(order) * core::f64::consts::FRAC_PI_2).sin()
                    })
                    .collect()
            };
            let [q, qd, qdd] = [0, 1, 2].map(wave);
            Motion { theta: q.clone(), thetad: qd.clone(), thetadd: qdd.clone(), q, qd, qdd }
        })
        .collect()
}
