#ifdef RNE_SIN_COS

// From outside.
void RNE_SIN_COS(double angle, double *sine, double *cosine);

static void PREFIX_sin_cos(double angle, double *sine, double *cosine)
{
    RNE_SIN_COS(angle, sine, cosine);
}

#else

// Settings under which a compiler computes other numbers than stand here.
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(_M_FP_FAST)
#error "the sine needs its sums in the order in which they stand: compile without -ffast-math and its like"
#endif
#if (FLT_EVAL_METHOD < 0) || (FLT_EVAL_METHOD == 2)
#error "the sine needs every number rounded to double: compile without -mfpmath=387 and its like"
#endif

// A number and its bits: C99 defines it, rule 19.2 of MISRA C advises against any union.
typedef union {
    double number;
    uint64_t bits;
} PREFIX_bits;

// Sine and cosine of an angle up to 1e5 rad, with errors below 1 ulp and without a branch.
static void PREFIX_sin_cos(double angle, double *sine, double *cosine)
{
    // angle = n pi/2 + y - e, with the integer n nearest to angle 2/pi (W. J. Cody and W. Waite).
    // To add 1.5 * 2^52 rounds to an integer, which then stands in the lowest bits of the sum. The
    // products of n and all parts of pi/2 but the last are exact; what the differences round away
    // is collected in e.
    const double rounded = 6755399441055744.0 + (angle * 0.6366197723675814);
    const double n = rounded - 6755399441055744.0;
    const double x1 = angle - (n * 1.5707963267341256);
    const double y = x1 - (n * 6.077100506303966e-11);
    const double e2 = (y - x1) + (n * 6.077100506303966e-11);
    const double e = e2 + (n * 2.0222662487959506e-21);

    // sin(y - e) and cos(y - e), with the polynomials of fdlibm
    const double z = y * y;
    const double zz = z * z;
    const double half = 0.5 * z;
    const double w = 1.0 - half;
    const double p45 = -2.5050760253406863e-8 + (z * 1.58969099521155e-10);
    const double p25 = (-1.984126982985795e-4 + (z * 2.7557313707070068e-6)) + (zz * p45);
    const double p = -1.6666666666666632e-1 + ((8.33333333332249e-3 * z) + (zz * p25));
    const double q45 = 2.087572321298175e-9 + (z * -1.1359647557788195e-11);
    const double q25 = (2.480158728947673e-5 + (z * -2.7557314351390663e-7)) + (zz * q45);
    const double q = 4.16666666666666e-2 + ((-1.388888888887411e-3 * z) + (zz * q25));

    // n mod 4 exchanges and negates the two
    PREFIX_bits quadrant;
    PREFIX_bits s;
    PREFIX_bits c;
    uint64_t exchange;
    quadrant.number = rounded;
    s.number = y - ((e * w) - ((z * y) * p));
    c.number = w + (((1.0 - w) - half) + ((y * e) + (zz * q)));
    exchange = (s.bits ^ c.bits) & (0u - (quadrant.bits & 1u));
    s.bits ^= exchange ^ ((quadrant.bits & 2u) << 62u);
    c.bits ^= exchange ^ (((quadrant.bits + 1u) & 2u) << 62u);
    *sine = s.number;
    *cosine = c.number;
}

#endif
