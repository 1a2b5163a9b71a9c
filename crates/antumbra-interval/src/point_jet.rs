//! Second-order jets of plain `f64`: for choosing where to look, never a proof.

/// About `f`, `f'` and `f''/2` along a line at one point, all rounded; NaN where undefined.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointJet {
    /// `f`.
    pub value: f64,
    /// `f'`.
    pub first: f64,
    /// `f''/2`.
    pub second: f64,
}

impl PointJet {
    /// `h(f)`, given `h`, `h'` and `h''` there.
    #[must_use]
    pub fn chain(self, value: f64, slope: f64, bend: f64) -> Self {
        let second = slope * self.second + 0.5 * bend * self.first * self.first;
        Self { value, first: slope * self.first, second }
    }

    /// Constant near the point.
    #[must_use]
    pub const fn flat(value: f64) -> Self {
        Self { value, first: 0.0, second: 0.0 }
    }

    /// `f^y` for a constant `y`, given its value.
    #[must_use]
    pub fn power(self, value: f64, y: f64) -> Self {
        let v = self.value;
        self.chain(value, y * value / v, y * (y - 1.0) * value / (v * v))
    }

    /// `f^n`.
    #[must_use]
    pub fn powi(self, n: i32) -> Self {
        // C's pow(NaN, 0) is 1: undefined must stay undefined.
        let undefined = self.value.is_nan() || (n < 0 && self.value == 0.0);
        let value = || if undefined { f64::NAN } else { core_math::pow(self.value, f64::from(n)) };
        match n {
            0 => Self::flat(value()),
            1 => self,
            2 => self.sqr(),
            3 => self.sqr() * self,
            4 => self.sqr().sqr(),
            _ => self.power(value(), f64::from(n)),
        }
    }

    /// `f^2`.
    #[must_use]
    #[inline(always)]
    pub fn sqr(self) -> Self {
        self * self
    }

    /// Square root.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let h = self.value.sqrt();
        self.chain(h, 0.5 / h, -0.25 / (h * self.value))
    }

    /// `|f|`.
    #[must_use]
    pub fn abs(self) -> Self {
        if self.value < 0.0 { -self } else { self }
    }

    /// The smaller one.
    #[must_use]
    pub fn min(self, o: Self) -> Self {
        if self.value <= o.value { self } else { o }
    }

    /// The larger one.
    #[must_use]
    pub fn max(self, o: Self) -> Self {
        if self.value >= o.value { self } else { o }
    }

    /// `f k`.
    #[must_use]
    #[inline(always)]
    pub fn scaled(self, k: f64) -> Self {
        Self { value: self.value * k, first: self.first * k, second: self.second * k }
    }
}

impl std::ops::Neg for PointJet {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.scaled(-1.0)
    }
}

impl std::ops::Add for PointJet {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { value: self.value + o.value, first: self.first + o.first, second: self.second + o.second }
    }
}

impl std::ops::Sub for PointJet {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { value: self.value - o.value, first: self.first - o.first, second: self.second - o.second }
    }
}

/// The product of the Taylor polynomials.
impl std::ops::Mul for PointJet {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Self {
            value: self.value * o.value,
            first: self.value * o.first + self.first * o.value,
            second: self.value * o.second + self.first * o.first + self.second * o.value,
        }
    }
}

/// `q = a / b` from `q b = a`, coefficient by coefficient.
impl std::ops::Div for PointJet {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let value = self.value / o.value;
        let first = (self.first - value * o.first) / o.value;
        Self { value, first, second: (self.second - value * o.second - first * o.first) / o.value }
    }
}
