/// Pseudorandom numbers, the same in every run (Steele, Lea and Flood's SplitMix64), from a seed.
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    /// One of 0, …, `bound` − 1.
    pub fn below(&mut self, bound: usize) -> usize {
        (self.bits() % bound as u64) as usize
    }

    /// True with probability 1/`times`.
    pub fn once_in(&mut self, times: usize) -> bool {
        self.below(times) == 0
    }

    /// One of the choices.
    pub fn one_of<T: Clone>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())].clone()
    }

    /// Uniform between the bounds.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform between −1 and 1.
    pub fn number(&mut self) -> f64 {
        self.between(-1.0, 1.0)
    }

    /// A number of either sign, up to 1.5.
    pub fn signed(&mut self) -> f64 {
        self.between(-1.5, 1.5)
    }

    /// A mass, a length or another positive constant, from 0.5 to 2.
    pub fn positive(&mut self) -> f64 {
        self.between(0.5, 2.0)
    }

    /// Positive, with a logarithm uniform between those of the bounds.
    pub fn size(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// An array of such numbers.
    pub fn array<const K: usize>(&mut self, number: fn(&mut Self) -> f64) -> [f64; K] {
        std::array::from_fn(|_| number(self))
    }

    /// An array of numbers between −1 and 1.
    pub fn vector<const K: usize>(&mut self) -> [f64; K] {
        self.array(Self::number)
    }

    /// A unit quaternion.
    pub fn quaternion(&mut self) -> [f64; 4] {
        let q: [f64; 4] = self.vector();
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length < 0.1 { self.quaternion() } else { q.map(|x| x / length) }
    }
}
