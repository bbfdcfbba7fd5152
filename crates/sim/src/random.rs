//! Numbers that look random and are the same every time.

/// SplitMix64 (Steele, Lea, Flood 2014): small, and good enough to scatter states.
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    /// The sequence of a seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Evenly from `-half` to `half`.
    pub(crate) fn within(&mut self, half: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        half * ((z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    }

    /// A unit quaternion, evenly over all rotations: a point of the cube that lies in the ball, scaled to the sphere.
    pub(crate) fn rotation(&mut self) -> [f64; 4] {
        loop {
            let q: [f64; 4] = std::array::from_fn(|_| self.within(1.0));
            let square: f64 = q.iter().map(|x| x * x).sum();
            if (1e-3..=1.0).contains(&square) {
                return q.map(|x| x / square.sqrt());
            }
        }
    }
}
