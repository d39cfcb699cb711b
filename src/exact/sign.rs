//! The answer of an exact predicate.

use std::ops::{Mul, Neg};

/// The sign of a real number that was never rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(i8)]
pub enum Sign {
    /// Less than zero.
    Negative = -1,
    /// Exactly zero.
    Zero = 0,
    /// Greater than zero.
    Positive = 1,
}

impl Sign {
    /// The sign of a finite number.
    ///
    /// ```
    /// use nusselt::exact::Sign;
    /// assert_eq!(Sign::of(-0.0), Sign::Zero);
    /// assert_eq!(Sign::of(5e-324), Sign::Positive);
    /// ```
    pub fn of(value: f64) -> Self {
        debug_assert!(!value.is_nan(), "a NaN has no sign");
        if value > 0.0 {
            Self::Positive
        } else if value < 0.0 {
            Self::Negative
        } else {
            Self::Zero
        }
    }

    /// True for [`Sign::Positive`].
    pub fn is_positive(self) -> bool {
        self == Self::Positive
    }

    /// True for [`Sign::Negative`].
    pub fn is_negative(self) -> bool {
        self == Self::Negative
    }

    /// True for [`Sign::Zero`].
    #[inline]
    pub fn is_zero(self) -> bool {
        self == Self::Zero
    }
}

impl Neg for Sign {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Zero => Self::Zero,
            Self::Positive => Self::Negative,
        }
    }
}

/// The sign of a product.
impl Mul for Sign {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        match self {
            Self::Negative => -other,
            Self::Zero => Self::Zero,
            Self::Positive => other,
        }
    }
}

/// The sign that an ordering against zero stands for.
impl From<std::cmp::Ordering> for Sign {
    fn from(ordering: std::cmp::Ordering) -> Self {
        match ordering {
            std::cmp::Ordering::Less => Self::Negative,
            std::cmp::Ordering::Equal => Self::Zero,
            std::cmp::Ordering::Greater => Self::Positive,
        }
    }
}
