//! A model, random states, and everything the algorithms write.

use crate::STATES;
use gyroflex::Scalar;
use gyroflex::dynamics::{
    AbaScratch, Acceleration, Contains, CrbaScratch, Deflections, DerivativeScratch, ElasticInverse,
    ElasticInverseScratch, External, Forward, ForwardDerivatives, Inverse, InverseDerivatives, JointMotion,
    JointOrders, MAX_COEFFICIENTS, RneaScratch, Smoothness, SmoothnessScratch, State, VANISHING, aba, crba,
    derivative_matrix_len, elastic_inverse, elastic_inverse_len, forward_derivatives, inverse_derivatives, placements,
    required_smoothness, rnea, smoothness_len,
};
use gyroflex::model::{Body, BodySpec, Fidelity, Knot, Model, RobotSpec, TransmissionSpec};
use gyroflex::spatial::{Transform, Vec3};

/// A robot's description in storage of its own.
#[derive(Clone, Debug)]
pub struct Spec {
    /// As in [`RobotSpec`].
    pub bodies: Vec<BodySpec>,
    /// As in [`RobotSpec`].
    pub spring_tables: Vec<[f64; 2]>,
    /// Gravity in world axes [m/s²].
    pub gravity: Vec3<f64>,
}

impl Spec {
    /// The same robot without drives: its plain rigid dynamics.
    pub fn without_drives(mut self) -> Self {
        for body in &mut self.bodies {
            body.drive = None;
        }
        self
    }

    /// The same robot without damping in its transmissions, whose inverse needs more derivatives.
    pub fn undamped(mut self) -> Self {
        for drive in self.bodies.iter_mut().filter_map(|b| b.drive.as_mut()) {
            if let TransmissionSpec::Elastic { damping, .. } = &mut drive.transmission {
                *damping = 0.0;
            }
        }
        self
    }

    /// Lowers it for one of the four models. The records stay for the life of the program, as an arm's do in a controller.
    pub fn lower<P: Scalar>(&self, fidelity: Fidelity) -> Model<'static, P> {
        let Self { bodies, spring_tables, gravity } = self;
        let spec = RobotSpec { bodies, spring_tables, gravity: *gravity };
        let mut records = vec![Body::empty(); bodies.len()];
        let mut knots = vec![Knot::EMPTY; spec.knots_needed()];
        spec.lower(fidelity, &mut records, &mut knots).unwrap_or_else(|e| panic!("{e}"));
        let records: Vec<Body<P>> = records.iter().map(Body::cast).collect();
        let knots: Vec<Knot<P>> = knots.iter().map(Knot::cast).collect();
        Model::new(records.leak(), knots.leak(), gravity.map(P::from_f64))
    }
}

/// What is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Algorithm {
    /// Forward dynamics.
    Aba,
    /// Inverse dynamics.
    Rnea,
    /// The inertia matrix.
    Crba,
    /// Poses of all links.
    Placements,
    /// Forward dynamics with its derivatives.
    ForwardDerivatives,
    /// Derivatives of inverse dynamics.
    InverseDerivatives,
    /// Motors and torques from the motion of the links, with elastic transmissions.
    ElasticInverse,
}

impl Algorithm {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Aba,
        Self::Rnea,
        Self::Crba,
        Self::Placements,
        Self::ForwardDerivatives,
        Self::InverseDerivatives,
        Self::ElasticInverse,
    ];

    /// Whether it computes derivatives, of which a call takes many times as long.
    pub const fn is_derivative(self) -> bool {
        matches!(self, Self::ForwardDerivatives | Self::InverseDerivatives)
    }

    /// The function's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Aba => "aba",
            Self::Rnea => "rnea",
            Self::Crba => "crba",
            Self::Placements => "placements",
            Self::ForwardDerivatives => "forward_derivatives",
            Self::InverseDerivatives => "inverse_derivatives",
            Self::ElasticInverse => "elastic_inverse",
        }
    }
}

/// Blocks of derivatives of inverse dynamics; forward dynamics has one less.
const DERIVATIVES: usize = 6;

/// A robot in one model and scalar, ready to be called.
#[derive(Debug)]
pub struct Workload<T: Scalar + 'static> {
    model: Model<'static, T::Param>,
    states: Vec<[Vec<T>; 5]>,
    aba: Vec<AbaScratch<T>>,
    rnea: Vec<RneaScratch<T>>,
    crba: Vec<CrbaScratch<T>>,
    out: [Vec<T>; 3],
    matrix: Vec<T>,
    poses: Vec<Transform<T>>,
    sensitivities: Vec<DerivativeScratch<T>>,
    derivative_matrix: Vec<T>,
    derivatives: [Vec<T>; 2],
    orders: Vec<JointOrders>,
    motion: Vec<T>,
    series: Vec<ElasticInverseScratch<T>>,
    start: Vec<T>,
    motors: [Vec<T>; 3],
}

impl<T: Scalar + 'static> Workload<T> {
    /// Prepares a robot for one of the four models.
    pub fn new(spec: &Spec, fidelity: Fidelity) -> Self {
        let model = spec.lower::<T::Param>(fidelity);
        let (n, nq, nv) = (model.bodies().len(), model.nq(), model.nv());
        let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
        let mut uniform = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let states = (0..STATES)
            .map(|_| {
                let q: Vec<f64> = (0..nq).map(|_| 3.0 * uniform()).collect();
                let theta = q.iter().take(nv).map(|q| q + 1e-3 * uniform()).collect();
                let mut vector = |scale: f64| (0..nv).map(|_| scale * uniform()).collect::<Vec<_>>();
                let (qd, thetad, tau) = (vector(2.0), vector(2.0), vector(20.0));
                [q, qd, theta, thetad, tau].map(|x| x.into_iter().map(T::from_f64).collect())
            })
            .collect();
        let zeros = |length| vec![T::zero(); length];
        let orders = orders(&spec.lower::<f64>(fidelity));
        let smoothness = Smoothness { joints: &orders, torque_derivatives: 0 };
        let motion = (0..smoothness.order() * nv).map(|i| T::from_f64(3f64.powi((i / nv) as i32) * uniform()));
        let (motion, coefficients) = (motion.collect(), elastic_inverse_len(&model, &smoothness));
        Self {
            motion,
            series: vec![ElasticInverseScratch::new(); coefficients.unwrap_or(0)],
            start: vec![T::from_f64(1e-3); nv],
            motors: [zeros(3 * nv), zeros(nv), zeros(nv)],
            orders,
            aba: vec![AbaScratch::new(); n],
            rnea: vec![RneaScratch::new(); n],
            crba: vec![CrbaScratch::new(); n],
            out: [zeros(nv), zeros(nv), zeros(nv)],
            matrix: zeros(nv * nv),
            poses: vec![Transform::identity(); n],
            sensitivities: vec![DerivativeScratch::new(); n],
            derivative_matrix: zeros(derivative_matrix_len(&model)),
            derivatives: [zeros(DERIVATIVES * nv * nv), zeros(DERIVATIVES * nv * nv)],
            model,
            states,
        }
    }

    /// Whether the algorithm is the one for this model: with rigidly geared rotors on far links, forward dynamics is not, and without
    /// an elastic joint there is nothing for the elastic inverse to do.
    pub fn takes(&self, algorithm: Algorithm) -> bool {
        match algorithm {
            Algorithm::Aba => !self.model.has_remote_rigid_rotor(),
            Algorithm::ElasticInverse => !self.series.is_empty() && self.orders.iter().any(|o| o.torque > 0),
            _ => true,
        }
    }

    /// How many derivatives of the motion the elastic inverse needs.
    pub fn order(&self) -> usize {
        Smoothness { joints: &self.orders, torque_derivatives: 0 }.order()
    }

    /// One call at state `i`.
    #[inline]
    pub fn call(&mut self, algorithm: Algorithm, i: usize) {
        let [q, qd, theta, thetad, tau] = &self.states[i % STATES];
        let (model, state) = (&self.model, State { q, qd, theta, thetad });
        let ([a, b, c], [d, e]) = (&mut self.out, &mut self.derivatives);
        let done = match algorithm {
            Algorithm::Aba => {
                let out = Forward { qdd: a, thetadd: b, tau_j: c };
                aba(model, state, tau, External::none(), &mut self.aba, out)
            }
            Algorithm::Rnea => {
                let accel = Acceleration { qdd: tau, thetadd: tau };
                rnea(model, state, accel, External::none(), &mut self.rnea, Inverse { tau_j: a, tau: b })
            }
            Algorithm::Crba => crba(model, q, &mut self.crba, &mut self.matrix),
            Algorithm::Placements => placements(model, q, &mut self.poses),
            Algorithm::ForwardDerivatives => {
                let length = (DERIVATIVES - 1) * a.len() * a.len();
                let value = Forward { qdd: a, thetadd: b, tau_j: c };
                let out = ForwardDerivatives { qdd: &mut d[..length], thetadd: &mut e[..length] };
                let (scratch, matrix) = (&mut self.sensitivities, &mut self.derivative_matrix);
                forward_derivatives(model, state, tau, External::none(), scratch, matrix, value, out)
            }
            Algorithm::InverseDerivatives => {
                let accel = Acceleration { qdd: tau, thetadd: tau };
                let out = InverseDerivatives { tau_j: d, tau: e };
                inverse_derivatives(model, state, accel, External::none(), &mut self.sensitivities, out)
            }
            Algorithm::ElasticInverse => {
                let smoothness = Smoothness { joints: &self.orders, torque_derivatives: 0 };
                let motion = JointMotion { q, derivatives: &self.motion };
                let [theta, deflection, deflection_rate] = &mut self.motors;
                // A deflection of about a milliradian.
                let now = Deflections { now: &self.start, step: T::from_f64(1e-3) };
                let out = ElasticInverse { theta, tau_j: a, tau: b, deflection, deflection_rate };
                let scratch = &mut self.series;
                elastic_inverse::<T, MAX_COEFFICIENTS>(model, &smoothness, motion, External::none(), now, scratch, out)
                    .unwrap_or_else(|e| panic!("{e}"));
                Ok(())
            }
        };
        done.unwrap_or_else(|e| panic!("{e}"));
    }
}

/// What the elastic inverse asks of every joint.
fn orders(model: &Model<'_, f64>) -> Vec<JointOrders> {
    let (n, nv) = (model.bodies().len(), model.nv());
    let mut orders = vec![JointOrders::default(); n];
    let scratch = SmoothnessScratch {
        bodies: &mut vec![DerivativeScratch::new(); n],
        numbers: &mut vec![0.0; smoothness_len(model)],
        contains: &mut vec![Contains::default(); nv * nv],
    };
    required_smoothness(model, 0, VANISHING, scratch, &mut orders).unwrap_or_else(|e| panic!("{e}"));
    orders
}
