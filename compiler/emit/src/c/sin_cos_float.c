#if defined(__ARM_ARCH) && !defined(__ARM_FP) && !defined(RNE_SOFT_FLOAT)
#error "float is computed by a library: add -mfpu and -mfloat-abi=hard, or -DRNE_SOFT_FLOAT to allow it"
#endif
#ifdef RNE_SIN_COS

// From outside.
void RNE_SIN_COS(float angle, float *sine, float *cosine);

static void PREFIX_sin_cos(float angle, float *sine, float *cosine)
{
    RNE_SIN_COS(angle, sine, cosine);
}

#else

// Settings under which a compiler computes other numbers than stand here.
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(_M_FP_FAST)
#error "the sine needs its sums in the order in which they stand: compile without -ffast-math and its like"
#endif
#if (FLT_EVAL_METHOD < 0) || (FLT_EVAL_METHOD == 1) || (FLT_EVAL_METHOD == 2)
#error "the sine needs every number rounded to float: compile without -mfpmath=387 and its like"
#endif

// A number and its bits: C99 defines it, rule 19.2 of MISRA C advises against any union.
typedef union {
    float number;
    uint32_t bits;
} PREFIX_bits;

// Sine and cosine of an angle up to 1e5 rad, with errors below 1 ulp and without a branch.
static void PREFIX_sin_cos(float angle, float *sine, float *cosine)
{
    // angle = n pi/2 + y - e, with the integer n nearest to angle 2/pi (W. J. Cody and W. Waite).
    // To add 1.5 * 2^23 rounds to an integer, which then stands in the lowest bits of the sum. The
    // products of n and all parts of pi/2 but the last are exact; what the differences round away
    // is collected in e.
    const float rounded = 12582912.0f + (angle * 0.63661975f);
    const float n = rounded - 12582912.0f;
    const float x1 = angle - (n * 1.5703125f);
    const float x2 = x1 - (n * 4.825592e-4f);
    const float x3 = x2 - (n * 1.2665987e-6f);
    const float e3 = (x3 - x2) + (n * 1.2665987e-6f);
    const float x4 = x3 - (n * 9.895302e-10f);
    const float e4 = (x4 - x3) + (n * 9.895302e-10f);
    const float y = x4 - (n * 2.5579538e-12f);
    const float e5 = (y - x4) + (n * 2.5579538e-12f);
    const float e = (e3 + e4 + e5) + (n * 5.390303e-15f);

    // sin(y - e) and cos(y - e), with the polynomials of S. L. Moshier's Cephes library
    const float z = y * y;
    const float zz = z * z;
    const float half = 0.5f * z;
    const float w = 1.0f - half;
    const float p = -1.6666655e-1f + ((8.332161e-3f * z) + (zz * -1.9515296e-4f));
    const float q = 4.1666646e-2f + ((-1.3887316e-3f * z) + (zz * 2.4433157e-5f));

    // n mod 4 exchanges and negates the two
    PREFIX_bits quadrant;
    PREFIX_bits s;
    PREFIX_bits c;
    uint32_t exchange;
    quadrant.number = rounded;
    s.number = y - ((e * w) - ((z * y) * p));
    c.number = w + (((1.0f - w) - half) + ((y * e) + (zz * q)));
    exchange = (s.bits ^ c.bits) & (0u - (quadrant.bits & 1u));
    s.bits ^= exchange ^ ((quadrant.bits & 2u) << 30u);
    c.bits ^= exchange ^ (((quadrant.bits + 1u) & 2u) << 30u);
    *sine = s.number;
    *cosine = c.number;
}

#endif
