#include <stdlib.h>
#include <string.h>

#include "PREFIX.h"
#include "fmi-types.h"

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#elif defined __GNUC__
#define EXPORT __attribute__((visibility("default")))
#else
#define EXPORT
#endif

// Value references: the places of the variables among the values of an instance.
enum {
    N = DOF,
    TIME = 0,
    Q = 1,
    QD = Q + N,
    QDD = QD + N,
    TAU = QDD + N,
    PARAMETERS = TAU + N,
    COUNT = COUNT_OF_VALUES,
    PAYLOAD = COUNT - 10
};

static const double START[COUNT] = {
    START_VALUES
};
static const char TOKEN[] = "INSTANTIATION_TOKEN";

// All that an instance computes with.
typedef struct {
    double values[COUNT];
    int is_evaluated;
} Model;

// The derivatives of the result by its three arrays of arguments: row i belongs to result i.
typedef double Blocks[3][N][N];

// Whether all numbers are finite: infinity minus infinity is not a number.
static int are_finite(const double *x, int count)
{
    int i;
    for (i = 0; i < count; i++) {
        if (!(x[i] - x[i] == 0.0)) {
            return 0;
        }
    }
    return 1;
}

EQUATIONS
static void ignored(const void *first, ...)
{
    (void)first;
}

static void restart(Model *model)
{
    memcpy(model->values, START, sizeof START);
    model->is_evaluated = 0;
}

static void evaluated(Model *model)
{
    if (!model->is_evaluated) {
        evaluate(model->values);
        model->is_evaluated = 1;
    }
}

static int is_among(unsigned reference, int first)
{
    return reference >= (unsigned)first && reference < (unsigned)(first + N);
}

// The part of a time by which a step may begin too early: masters add up the same times in different ways.
#define TIME_TOLERANCE 1e-6

// A step of co-simulation from `time` on. Returns what is wrong, or NULL. A step that is refused changes nothing.
static const char *stepped(Model *model, double time, double duration)
{
    const double now = model->values[TIME];
    const double size = (now < 0.0 ? -now : now) + duration;
    const char *wrong;
    if (!are_finite(&time, 1)) {
        return "the time at which the step begins is not finite";
    }
    if (!(duration >= 0.0) || !are_finite(&duration, 1)) {
        return "the step size is negative or not finite; it must be 0 s or more";
    }
    if (now - time > TIME_TOLERANCE * size) {
        return "the step begins before the end of the last step; time cannot go backwards without a reset or a stored "
               "state";
    }
    model->is_evaluated = 0;
    wrong = integrate(model->values, duration);
    if (wrong == NULL) {
        model->values[TIME] = time + duration;
    }
    return wrong;
}

static int get(Model *model, const unsigned *references, size_t count, double *values)
{
    size_t i;
    for (i = 0; i < count; i++) {
        if (references[i] >= COUNT) {
            return 0;
        }
        if (is_among(references[i], RESULT)) {
            evaluated(model);
        }
        values[i] = model->values[references[i]];
    }
    return 1;
}

static int set(Model *model, const unsigned *references, size_t count, const double *values)
{
    size_t i;
    for (i = 0; i < count; i++) {
        if (references[i] >= COUNT || references[i] == TIME || is_among(references[i], RESULT)) {
            return 0;
        }
        model->values[references[i]] = values[i];
    }
    model->is_evaluated = 0;
    return 1;
}

// A derivative of an unknown by a known; 0 in `is_defined` where the model has no such derivative.
static double partial(Blocks blocks, unsigned unknown, unsigned known, int *is_defined)
{
    const int starts[3] = {Q, QD, THIRD};
    int block;
    for (block = 0; block < 3 && !is_among(known, starts[block]); block++) {
    }
    if (block == 3) {
        *is_defined = 0;
        return 0.0;
    }
    if (is_among(unknown, RESULT)) {
        return blocks[block][unknown - RESULT][known - (unsigned)starts[block]];
    }
    // states are outputs, and qd is the derivative of q
    *is_defined = *is_defined && STATES && (is_among(unknown, Q) || is_among(unknown, QD));
    return unknown == known ? 1.0 : 0.0;
}

// The Jacobian of the unknowns times a column of seeds, or a row of seeds times the Jacobian.
static int product(Model *model, const unsigned *unknowns, size_t rows, const unsigned *knowns, size_t columns,
                   const double *seed, double *result, int is_row)
{
    size_t i, j;
    int is_defined = 1;
    Blocks blocks;
    derivatives(model->values, blocks);
    memset(result, 0, (is_row ? columns : rows) * sizeof *result);
    for (i = 0; i < rows; i++) {
        for (j = 0; j < columns; j++) {
            const double element = partial(blocks, unknowns[i], knowns[j], &is_defined);
            result[is_row ? j : i] += element * seed[is_row ? i : j];
        }
    }
    return is_defined;
}

