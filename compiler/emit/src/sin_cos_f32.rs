#[allow(clippy::all, clippy::pedantic)]
impl Scalar for f32 {
    fn from_f64(value: f64) -> Self {
        value as f32
    }

    /// Of an angle up to 1e5 rad, with errors below 1 ulp and without a branch.
    fn sin_cos(self) -> (Self, Self) {
        let angle = self;
        // angle = n pi/2 + y - e, with the integer n nearest to angle 2/pi (W. J. Cody and W. Waite).
        // To add 1.5 * 2^23 rounds to an integer, which then stands in the lowest bits of the sum. The
        // products of n and all parts of pi/2 but the last are exact; what the differences round away
        // is collected in e.
        let rounded = 12582912.0 + angle * 0.63661975;
        let n = rounded - 12582912.0;
        let x1 = angle - n * 1.5703125;
        let x2 = x1 - n * 4.825592e-4;
        let x3 = x2 - n * 1.2665987e-6;
        let e3 = (x3 - x2) + n * 1.2665987e-6;
        let x4 = x3 - n * 9.895302e-10;
        let e4 = (x4 - x3) + n * 9.895302e-10;
        let y = x4 - n * 2.5579538e-12;
        let e5 = (y - x4) + n * 2.5579538e-12;
        let e = (e3 + e4 + e5) + n * 5.390303e-15;

        // sin(y - e) and cos(y - e), with the polynomials of S. L. Moshier's Cephes library
        let z = y * y;
        let zz = z * z;
        let half = 0.5 * z;
        let w = 1.0 - half;
        let p = -1.6666655e-1 + (8.332161e-3 * z + zz * -1.9515296e-4);
        let q = 4.1666646e-2 + (-1.3887316e-3 * z + zz * 2.4433157e-5);

        // n mod 4 exchanges and negates the two
        let quadrant = rounded.to_bits();
        let s = (y - (e * w - z * y * p)).to_bits();
        let c = (w + (((1.0 - w) - half) + (y * e + zz * q))).to_bits();
        let exchange = (s ^ c) & (quadrant & 1).wrapping_neg();
        (
            f32::from_bits(s ^ exchange ^ ((quadrant & 2) << 30)),
            f32::from_bits(c ^ exchange ^ ((quadrant.wrapping_add(1) & 2) << 30)),
        )
    }
}
