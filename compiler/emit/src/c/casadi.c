// CasADi's external interface. A missing argument (0) is zero, and a result that is not asked for (0) is not written.
#ifdef __cplusplus
extern "C" {
#endif

#ifndef casadi_real
#define casadi_real double
#endif
#ifndef casadi_int
#define casadi_int long long int
#endif
#ifndef CASADI_SYMBOL_EXPORT
#if defined(_WIN32) || defined(__CYGWIN__)
#define CASADI_SYMBOL_EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define CASADI_SYMBOL_EXPORT __attribute__((visibility("default")))
#else
#define CASADI_SYMBOL_EXPORT
#endif
#endif

// The functions that describe `f` to CasADi, and the head of `f`. They keep no memory: threads may share them.
#define PREFIX_external(f, inputs, outputs) \
    CASADI_SYMBOL_EXPORT casadi_int f##_n_in(void); \
    CASADI_SYMBOL_EXPORT casadi_int f##_n_out(void); \
    CASADI_SYMBOL_EXPORT const char *f##_name_in(casadi_int i); \
    CASADI_SYMBOL_EXPORT const char *f##_name_out(casadi_int i); \
    CASADI_SYMBOL_EXPORT const casadi_int *f##_sparsity_in(casadi_int i); \
    CASADI_SYMBOL_EXPORT const casadi_int *f##_sparsity_out(casadi_int i); \
    CASADI_SYMBOL_EXPORT int f##_work(casadi_int *sz_arg, casadi_int *sz_res, casadi_int *sz_iw, casadi_int *sz_w); \
    CASADI_SYMBOL_EXPORT int f(const casadi_real **arg, casadi_real **res, casadi_int *iw, casadi_real *w, int mem); \
    casadi_int f##_n_in(void) { return inputs; } \
    casadi_int f##_n_out(void) { return outputs; } \
    const char *f##_name_in(casadi_int i) { return (i >= 0 && i < inputs) ? PREFIX_names_##f[i] : 0; } \
    const char *f##_name_out(casadi_int i) { return (i >= 0 && i < outputs) ? PREFIX_names_##f[inputs + i] : 0; } \
    const casadi_int *f##_sparsity_in(casadi_int i) { return (i >= 0 && i < inputs) ? PREFIX_patterns_##f[i] : 0; } \
    const casadi_int *f##_sparsity_out(casadi_int i) \
    { \
        return (i >= 0 && i < outputs) ? PREFIX_patterns_##f[inputs + i] : 0; \
    } \
    int f##_work(casadi_int *sz_arg, casadi_int *sz_res, casadi_int *sz_iw, casadi_int *sz_w) \
    { \
        if (sz_arg) { *sz_arg = inputs; } \
        if (sz_res) { *sz_res = outputs; } \
        if (sz_iw) { *sz_iw = 0; } \
        if (sz_w) { *sz_w = 0; } \
        return 0; \
    } \
    int f(const casadi_real **arg, casadi_real **res, casadi_int *iw, casadi_real *w, int mem)

static const casadi_real PREFIX_zeros[LONGEST] = {0};

static const casadi_real *PREFIX_given(const casadi_real *argument)
{
    return argument ? argument : PREFIX_zeros;
}
