//! A tree of bodies, springs between coordinates, states and expected values; `stages/models.py` has the formats.

use std::path::Path;

/// How many states every program walks through, so that no branch predictor learns one by heart.
pub const STATES: usize = 256;

/// A body and the joint that moves it.
#[derive(Clone, Debug)]
pub struct Body {
    /// Index of the parent body; `None` is the world.
    pub parent: Option<usize>,
    /// `RX`, `RY`, `RZ` or `floating`.
    pub joint: String,
    /// Axis of a turning joint.
    pub axis: [f64; 3],
    /// Rotation of the joint frame in the parent's, by rows.
    pub rotation: [f64; 9],
    /// Origin of the joint frame in the parent's [m].
    pub position: [f64; 3],
    /// Mass [kg].
    pub mass: f64,
    /// Centre of mass [m].
    pub centre: [f64; 3],
    /// Inertia about it: xx, xy, yy, xz, yz, zz [kg m²].
    pub inertia: [f64; 6],
}

/// A transmission between the coordinates of a rotor and of a link.
#[derive(Clone, Copy, Debug)]
pub struct Spring {
    /// Index of the rotor in `q`.
    pub rotor_q: usize,
    /// Index of the rotor in `v`.
    pub rotor_v: usize,
    /// Index of the link in `q`.
    pub link_q: usize,
    /// Index of the link in `v`.
    pub link_v: usize,
    /// Rotor turns per joint turn.
    pub gear: f64,
    /// Link side [N m/rad].
    pub stiffness: f64,
    /// Link side [N m s/rad].
    pub damping: f64,
}

/// A robot of the comparison.
#[derive(Clone, Debug)]
pub struct Tree {
    /// Its name.
    pub name: String,
    /// Length of `q`.
    pub nq: usize,
    /// Length of `v`.
    pub nv: usize,
    /// Gravity, downwards [m/s²].
    pub gravity: f64,
    /// Parents before children.
    pub bodies: Vec<Body>,
    /// Empty for a rigid robot.
    pub springs: Vec<Spring>,
    /// Per velocity coordinate the gear ratio of a rotor, else 1.
    pub gears: Vec<f64>,
    /// Accelerations of state 0 without torques and springs.
    pub still: Vec<f64>,
    states: Vec<f64>,
    expected: Vec<f64>,
    derivatives: Vec<f64>,
}

impl Tree {
    /// Reads a robot.
    pub fn read(folder: &Path, name: &str) -> Self {
        let text = read(folder, name, "tree");
        let text = String::from_utf8_lossy(&text);
        let mut lines = text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
        let head: Vec<f64> = lines.next().unwrap_or_default().iter().map(|w| number(w)).collect();
        let [bodies, nq, nv, springs] = [0, 1, 2, 3].map(|i| head[i] as usize);
        let bodies = lines.by_ref().take(bodies).map(|words| body(&words)).collect();
        let springs: Vec<Spring> = lines.take(springs).map(|words| spring(&words)).collect();
        let mut gears = vec![1.0; nv];
        for s in &springs {
            gears[s.rotor_v] = s.gear;
        }
        let [states, expected, derivatives, still] =
            ["states", "expected", "derivatives", "still"].map(|kind| numbers(folder, name, kind));
        let name = name.to_owned();
        Self { name, nq, nv, gravity: head[4], bodies, springs, gears, still, states, expected, derivatives }
    }

    /// Whether the root is free.
    pub fn floating(&self) -> bool {
        self.bodies.first().is_some_and(|b| b.joint == "floating")
    }

    /// `q, v, a, u` of state `k`.
    pub fn state(&self, k: usize) -> [&[f64]; 4] {
        let (nq, nv) = (self.nq, self.nv);
        let row = &self.states[k * (nq + 3 * nv)..][..nq + 3 * nv];
        [&row[..nq], &row[nq..nq + nv], &row[nq + nv..nq + 2 * nv], &row[nq + 2 * nv..]]
    }

    /// What is expected at state `k`: accelerations for `u`, torques for `a`, `M(q) a`, and 12 numbers a body for its pose.
    pub fn expected(&self, k: usize) -> [&[f64]; 4] {
        let (nv, width) = (self.nv, 3 * self.nv + 12 * self.bodies.len());
        let row = &self.expected[k * width..][..width];
        [&row[..nv], &row[nv..2 * nv], &row[2 * nv..3 * nv], &row[3 * nv..]]
    }

    /// What is expected of derivatives at state `k`: of the accelerations by `q` and by `v` along `a`, and by `u` along `u`; of
    /// the torques without the springs by `q` and by `v` along `a`.
    pub fn expected_derivatives(&self, k: usize) -> [&[f64]; 5] {
        let row = &self.derivatives[k * 5 * self.nv..][..5 * self.nv];
        std::array::from_fn(|i| &row[i * self.nv..][..self.nv])
    }

    /// `out = torques + sign ·` what the springs exert.
    pub fn add_springs(&self, q: &[f64], v: &[f64], torques: &[f64], sign: f64, out: &mut [f64]) {
        out.copy_from_slice(torques);
        add_springs(&self.springs, q, v, sign, out);
    }

    /// Largest difference of accelerations over the largest, rotors seen through their gears, so that their great numbers
    /// hide no error of a link.
    pub fn acceleration_error(&self, got: &[f64], want: &[f64]) -> f64 {
        error(got.iter().zip(&self.gears).map(|(x, n)| x / n), want.iter().zip(&self.gears).map(|(x, n)| x / n))
    }

    /// The same of torques.
    pub fn torque_error(&self, got: &[f64], want: &[f64]) -> f64 {
        error(got.iter().zip(&self.gears).map(|(x, n)| x * n), want.iter().zip(&self.gears).map(|(x, n)| x * n))
    }
}

/// Adds `sign ·` what the springs exert to `torques`.
pub fn add_springs(springs: &[Spring], q: &[f64], v: &[f64], sign: f64, torques: &mut [f64]) {
    for s in springs {
        let deflection = q[s.rotor_q] / s.gear - q[s.link_q];
        let f = sign * (s.stiffness * deflection + s.damping * (v[s.rotor_v] / s.gear - v[s.link_v]));
        torques[s.link_v] += f;
        torques[s.rotor_v] -= f / s.gear;
    }
}

/// Largest difference over the largest wanted number; infinite where a number is missing or is none.
pub fn error(got: impl ExactSizeIterator<Item = f64>, want: impl ExactSizeIterator<Item = f64>) -> f64 {
    let same_length = got.len() == want.len();
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for (a, b) in got.zip(want) {
        // NaN must not get lost in a maximum.
        worst = if (a - b).is_finite() { worst.max((a - b).abs()) } else { f64::INFINITY };
        largest = largest.max(b.abs());
    }
    if same_length { worst / largest } else { f64::INFINITY }
}

fn read(folder: &Path, name: &str, kind: &str) -> Vec<u8> {
    let path = folder.join(format!("{name}.{kind}"));
    std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}; run the stage `models`", path.display()))
}

/// All numbers of a file of them.
pub fn numbers(folder: &Path, name: &str, kind: &str) -> Vec<f64> {
    let bytes = read(folder, name, kind);
    let words = bytes.chunks_exact(8);
    words.map(|b| f64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]])).collect()
}

fn number(word: &str) -> f64 {
    word.parse().unwrap_or_else(|_| panic!("`{word}` is not a number; run the stage `models` again"))
}

fn body(words: &[&str]) -> Body {
    let mut numbers = words[2..].iter().map(|w| number(w));
    let mut next = || numbers.next().unwrap_or(f64::NAN);
    Body {
        parent: usize::try_from(number(words[0]) as i64).ok(),
        joint: words[1].to_owned(),
        axis: std::array::from_fn(|_| next()),
        rotation: std::array::from_fn(|_| next()),
        position: std::array::from_fn(|_| next()),
        mass: next(),
        centre: std::array::from_fn(|_| next()),
        inertia: std::array::from_fn(|_| next()),
    }
}

fn spring(words: &[&str]) -> Spring {
    let [rotor_q, rotor_v, link_q, link_v] = [0, 1, 2, 3].map(|i| number(words[i]) as usize);
    let [gear, stiffness, damping] = [4, 5, 6].map(|i| number(words[i]));
    Spring { rotor_q, rotor_v, link_q, link_v, gear, stiffness, damping }
}
