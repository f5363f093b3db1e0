//! Sine and cosine as in fdlibm 5.3, bit-identical to the golden traces on every machine (`spec/02` §15).
//!
//! The algorithm is that of fdlibm, as published. The angle is reduced by multiples of π/2 in two or three
//! parts (Cody and Waite). A polynomial on [−π/4, π/4] is then evaluated in Horner's order. Other libraries,
//! such as the `libm` crate, evaluate the polynomials in a different order and differ in the last bit for
//! about one argument in a hundred.

/// The largest angle that this module reduces. Larger angles are passed to the `libm` crate, but no rotation
/// in a game of 2,000 ticks reaches them.
const LARGEST: f64 = 823_549.66;

/// Returns the sine of an angle in radians.
pub(crate) fn sin(angle: f64) -> f64 {
    match reduced(angle) {
        None => libm::sin(angle),
        Some((0, y, tail)) => kernel_sin(y, tail),
        Some((1, y, tail)) => kernel_cos(y, tail),
        Some((2, y, tail)) => -kernel_sin(y, tail),
        Some((_, y, tail)) => -kernel_cos(y, tail),
    }
}

/// Returns the cosine of an angle in radians.
pub(crate) fn cos(angle: f64) -> f64 {
    match reduced(angle) {
        None => libm::cos(angle),
        Some((0, y, tail)) => kernel_cos(y, tail),
        Some((1, y, tail)) => -kernel_sin(y, tail),
        Some((2, y, tail)) => -kernel_cos(y, tail),
        Some((_, y, tail)) => kernel_sin(y, tail),
    }
}

/// Returns the upper 32 bits of a number, without the sign.
fn high(x: f64) -> u32 {
    (x.to_bits() >> 32) as u32 & 0x7fff_ffff
}

/// Returns the sine on [−π/4, π/4]. `tail` is the exact argument minus `x`, or `None` if `x` is exact.
#[expect(clippy::excessive_precision, reason = "the coefficients as published")]
fn kernel_sin(x: f64, tail: Option<f64>) -> f64 {
    const S1: f64 = -1.666_666_666_666_663_243_48e-01;
    const S2: f64 = 8.333_333_333_322_489_461_24e-03;
    const S3: f64 = -1.984_126_982_985_794_931_34e-04;
    const S4: f64 = 2.755_731_370_707_006_767_89e-06;
    const S5: f64 = -2.505_076_025_340_686_341_95e-08;
    const S6: f64 = 1.589_690_995_211_550_102_21e-10;
    if high(x) < 0x3e40_0000 {
        return x;
    }
    let z = x * x;
    let v = z * x;
    let r = S2 + z * (S3 + z * (S4 + z * (S5 + z * S6)));
    match tail {
        None => x + v * (S1 + z * r),
        Some(y) => x - ((z * (0.5 * y - v * r) - y) - v * S1),
    }
}

#[expect(clippy::excessive_precision, reason = "the coefficients as published")]
fn kernel_cos(x: f64, tail: Option<f64>) -> f64 {
    const C1: f64 = 4.166_666_666_666_660_190_37e-02;
    const C2: f64 = -1.388_888_888_887_410_957_49e-03;
    const C3: f64 = 2.480_158_728_947_672_941_78e-05;
    const C4: f64 = -2.755_731_435_139_066_330_35e-07;
    const C5: f64 = 2.087_572_321_298_174_827_90e-09;
    const C6: f64 = -1.135_964_755_778_819_482_65e-11;
    let size = high(x);
    if size < 0x3e40_0000 {
        return 1.0;
    }
    let y = tail.unwrap_or(0.0);
    let z = x * x;
    let r = z * (C1 + z * (C2 + z * (C3 + z * (C4 + z * (C5 + z * C6)))));
    if size < 0x3fd3_3333 {
        return 1.0 - (0.5 * z - (z * r - x * y));
    }
    let quarter =
        if size > 0x3fe9_0000 { 0.28125 } else { f64::from_bits(u64::from(size - 0x0020_0000) << 32) };
    let half = 0.5 * z - quarter;
    let rest = 1.0 - quarter;
    rest - (half - (z * r - x * y))
}

/// Returns the quadrant, the angle within the quadrant, and the rounding error of that angle. Returns `None`
/// for NaN and for angles that are too large.
fn reduced(angle: f64) -> Option<(i32, f64, Option<f64>)> {
    const PART_1: f64 = f64::from_bits(0x3FF9_21FB_5440_0000);
    const PART_1_TAIL: f64 = f64::from_bits(0x3DD0_B461_1A62_6331);
    const PART_2: f64 = f64::from_bits(0x3DD0_B461_1A60_0000);
    const PART_2_TAIL: f64 = f64::from_bits(0x3BA3_198A_2E03_7073);
    const PART_3: f64 = f64::from_bits(0x3BA3_198A_2E00_0000);
    const PART_3_TAIL: f64 = f64::from_bits(0x397B_839A_2520_49C1);
    const TWO_OVER_PI: f64 = std::f64::consts::FRAC_2_PI;

    let size = high(angle);
    if size <= 0x3fe9_21fb {
        return Some((0, angle, None));
    }
    if angle.is_nan() || angle.abs() > LARGEST {
        return None;
    }
    let sign = if angle < 0.0 { -1.0 } else { 1.0 };
    let whole = angle.abs();
    let exponent = |x: f64| (high(x) >> 20) as i32;
    let (count, y, tail) = if size < 0x4002_d97c {
        let mut rest = whole - PART_1;
        let mut part = PART_1_TAIL;
        if size == 0x3ff9_21fb {
            rest -= PART_2;
            part = PART_2_TAIL;
        }
        let y = rest - part;
        (1, y, (rest - y) - part)
    } else {
        let count = (whole * TWO_OVER_PI + 0.5) as i32;
        let n = f64::from(count);
        let mut rest = whole - n * PART_1;
        let mut part = n * PART_1_TAIL;
        let mut y = rest - part;
        let near_multiple = count >= 32 || size == high(n * std::f64::consts::FRAC_PI_2);
        if near_multiple && exponent(whole) - exponent(y) > 16 {
            let before = rest;
            part = n * PART_2;
            rest = before - part;
            part = n * PART_2_TAIL - ((before - rest) - part);
            y = rest - part;
            if exponent(whole) - exponent(y) > 49 {
                let before = rest;
                part = n * PART_3;
                rest = before - part;
                part = n * PART_3_TAIL - ((before - rest) - part);
                y = rest - part;
            }
        }
        (count, y, (rest - y) - part)
    };
    let quadrant = if sign < 0.0 { -count } else { count } & 3;
    Some((quadrant, sign * y, Some(sign * tail)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks vectors T5 and T14 in `spec/02` §17.
    #[test]
    fn vectors_of_the_reference() {
        assert_eq!((cos(0.3), sin(0.3)), (0.955_336_489_125_606, 0.295_520_206_661_339_55));
        assert_eq!((cos(0.0), sin(0.0)), (1.0, 0.0));
        assert_eq!(sin(-0.0).to_bits(), (-0.0f64).to_bits());
    }

    #[test]
    fn within_a_rounding_of_another_library() {
        for step in -40_000..40_000 {
            let angle = f64::from(step) * 0.012_345;
            assert!((sin(angle) - libm::sin(angle)).abs() < 3e-16, "{angle}");
            assert!((cos(angle) - libm::cos(angle)).abs() < 3e-16, "{angle}");
        }
        assert!(sin(f64::NAN).is_nan() && cos(f64::INFINITY).is_nan());
        assert_eq!(sin(1e9), libm::sin(1e9));
    }
}
