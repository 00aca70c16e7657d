typedef struct {
    Model model;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
} Instance;

static fmi3Status failed(fmi3Instance i, const char *message)
{
    const Instance *instance = i;
    if (instance != NULL && instance->log != NULL) {
        instance->log(instance->environment, fmi3Error, "error", message);
    }
    return fmi3Error;
}

EXPORT const char *FMI(GetVersion)(void)
{
    return "3.0";
}

static fmi3Instance instantiated(fmi3String token, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    Instance *instance = calloc(1u, sizeof *instance);
    if (instance == NULL) {
        return NULL;
    }
    instance->environment = environment;
    instance->log = log;
    restart(&instance->model);
    if (token == NULL || strcmp(token, TOKEN) != 0) {
        failed(instance, "the instantiation token is not that of this FMU");
        free(instance);
        return NULL;
    }
    return instance;
}

EXPORT fmi3Instance FMI(InstantiateModelExchange)(fmi3String name, fmi3String token, fmi3String resources,
                                                  fmi3Boolean visible, fmi3Boolean logging,
                                                  fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    ignored(name, resources, visible, logging);
    return instantiated(token, environment, log);
}

EXPORT fmi3Instance FMI(InstantiateCoSimulation)(fmi3String name, fmi3String token, fmi3String resources,
                                                 fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean event_mode,
                                                 fmi3Boolean early_return, const fmi3ValueReference intermediate[],
                                                 size_t count, fmi3InstanceEnvironment environment,
                                                 fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update)
{
    ignored(name, resources, visible, logging, event_mode, early_return, intermediate, count, update);
    return instantiated(token, environment, log);
}

EXPORT fmi3Instance FMI(InstantiateScheduledExecution)(fmi3String name, fmi3String token, fmi3String resources,
                                                       fmi3Boolean visible, fmi3Boolean logging,
                                                       fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                                       fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
                                                       fmi3UnlockPreemptionCallback unlock)
{
    ignored(name, token, resources, visible, logging, environment, log, update, lock, unlock);
    return NULL;
}

EXPORT fmi3Status FMI(EnterInitializationMode)(fmi3Instance i, fmi3Boolean has_tolerance, fmi3Float64 tolerance,
                                               fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop)
{
    ignored(i, has_tolerance, tolerance, has_stop, stop);
    ((Instance *)i)->model.values[TIME] = start;
    return fmi3OK;
}

MODE(EnterConfigurationMode)
MODE(ExitConfigurationMode)
MODE(EvaluateDiscreteStates)
MODE(EnterStepMode)

EXPORT fmi3Status FMI(GetFloat64)(fmi3Instance i, const fmi3ValueReference references[], size_t count,
                                  fmi3Float64 values[], size_t n)
{
    return status(i, n == count && get(&((Instance *)i)->model, references, count, values),
                  "no variable has this value reference");
}

EXPORT fmi3Status FMI(SetFloat64)(fmi3Instance i, const fmi3ValueReference references[], size_t count,
                                  const fmi3Float64 values[], size_t n)
{
    return status(i, n == count && set(&((Instance *)i)->model, references, count, values),
                  "this variable cannot be set");
}

// What the FMU has none of: an error unless nothing is asked for.
static fmi3Status none(fmi3Instance i, size_t count)
{
    return status(i, i != NULL && count == 0u, "all variables are of type Float64");
}

#define NO_VARIABLES(name, type) \
    EXPORT fmi3Status FMI(Get##name)(fmi3Instance i, const fmi3ValueReference r[], size_t count, type v[], size_t n) \
    { \
        ignored(r, v, n); \
        return none(i, count); \
    } \
    EXPORT fmi3Status FMI(Set##name)(fmi3Instance i, const fmi3ValueReference r[], size_t count, const type v[], \
                                     size_t n) \
    { \
        ignored(r, v, n); \
        return none(i, count); \
    }
NO_VARIABLES(Float32, fmi3Float32)
NO_VARIABLES(Int8, fmi3Int8)
NO_VARIABLES(UInt8, fmi3UInt8)
NO_VARIABLES(Int16, fmi3Int16)
NO_VARIABLES(UInt16, fmi3UInt16)
NO_VARIABLES(Int32, fmi3Int32)
NO_VARIABLES(UInt32, fmi3UInt32)
NO_VARIABLES(Int64, fmi3Int64)
NO_VARIABLES(UInt64, fmi3UInt64)
NO_VARIABLES(Boolean, fmi3Boolean)
NO_VARIABLES(String, fmi3String)

// Functions of binary variables and clocks: their arguments after the number of value references.
#define NOTHING(name, last, ...) \
    EXPORT fmi3Status FMI(name)(fmi3Instance i, const fmi3ValueReference r[], size_t count, __VA_ARGS__) \
    { \
        ignored(r, last); \
        return none(i, count); \
    }
#define BINARY(name, last, ...) \
    EXPORT fmi3Status FMI(name)(fmi3Instance i, const fmi3ValueReference r[], size_t count, __VA_ARGS__, size_t n) \
    { \
        ignored(r, sizes, last, n); \
        return none(i, count); \
    }
BINARY(GetBinary, v, size_t sizes[], fmi3Binary v[])
BINARY(SetBinary, v, const size_t sizes[], const fmi3Binary v[])
NOTHING(GetClock, v, fmi3Clock v[])
NOTHING(SetClock, v, const fmi3Clock v[])
NOTHING(GetShiftDecimal, v, fmi3Float64 v[])
NOTHING(SetIntervalDecimal, v, const fmi3Float64 v[])
NOTHING(SetShiftDecimal, v, const fmi3Float64 v[])

#define TWO(name, a, b) \
    EXPORT fmi3Status FMI(name)(fmi3Instance i, const fmi3ValueReference r[], size_t count, a x[], b y[]) \
    { \
        ignored(r, x, y); \
        return none(i, count); \
    }
TWO(GetIntervalDecimal, fmi3Float64, fmi3IntervalQualifier)
TWO(GetShiftFraction, fmi3UInt64, fmi3UInt64)
TWO(SetIntervalFraction, const fmi3UInt64, const fmi3UInt64)
TWO(SetShiftFraction, const fmi3UInt64, const fmi3UInt64)

EXPORT fmi3Status FMI(GetIntervalFraction)(fmi3Instance i, const fmi3ValueReference r[], size_t count, fmi3UInt64 x[],
                                           fmi3UInt64 y[], fmi3IntervalQualifier z[])
{
    ignored(r, x, y, z);
    return none(i, count);
}

EXPORT fmi3Status FMI(GetNumberOfVariableDependencies)(fmi3Instance i, fmi3ValueReference r, size_t *count)
{
    ignored(count, r);
    return failed(i, "the dependencies do not change; modelDescription.xml lists them");
}

EXPORT fmi3Status FMI(GetVariableDependencies)(fmi3Instance i, fmi3ValueReference dependent, size_t elements[],
                                               fmi3ValueReference independents[], size_t of_independents[],
                                               fmi3DependencyKind kinds[], size_t count)
{
    ignored(elements, dependent, independents, of_independents, kinds, count);
    return failed(i, "the dependencies do not change; modelDescription.xml lists them");
}

EXPORT fmi3Status FMI(GetDirectionalDerivative)(fmi3Instance i, const fmi3ValueReference unknowns[], size_t rows,
                                                const fmi3ValueReference knowns[], size_t columns,
                                                const fmi3Float64 seed[], size_t seeds, fmi3Float64 result[],
                                                size_t results)
{
    return status(i, seeds == columns && results == rows &&
                  product(&((Instance *)i)->model, unknowns, rows, knowns, columns, seed, result, 0),
                  "there is no derivative of these variables");
}

EXPORT fmi3Status FMI(GetAdjointDerivative)(fmi3Instance i, const fmi3ValueReference unknowns[], size_t rows,
                                            const fmi3ValueReference knowns[], size_t columns,
                                            const fmi3Float64 seed[], size_t seeds, fmi3Float64 result[],
                                            size_t results)
{
    return status(i, seeds == rows && results == columns &&
                  product(&((Instance *)i)->model, unknowns, rows, knowns, columns, seed, result, 1),
                  "there is no derivative of these variables");
}

EXPORT fmi3Status FMI(UpdateDiscreteStates)(fmi3Instance i, fmi3Boolean *again, fmi3Boolean *terminate,
                                            fmi3Boolean *nominals, fmi3Boolean *values, fmi3Boolean *has_next,
                                            fmi3Float64 *next)
{
    ignored(i);
    *again = *terminate = *nominals = *values = *has_next = false;
    *next = 0.0;
    return fmi3OK;
}

EXPORT fmi3Status FMI(GetEventIndicators)(fmi3Instance i, fmi3Float64 x[], size_t count)
{
    ignored(x);
    return none(i, count);
}

EXPORT fmi3Status FMI(GetNumberOfEventIndicators)(fmi3Instance i, size_t *count)
{
    ignored(i);
    *count = 0u;
    return fmi3OK;
}

EXPORT fmi3Status FMI(GetNumberOfContinuousStates)(fmi3Instance i, size_t *count)
{
    ignored(i);
    *count = STATES;
    return fmi3OK;
}

EXPORT fmi3Status FMI(GetOutputDerivatives)(fmi3Instance i, const fmi3ValueReference r[], size_t count,
                                            const fmi3Int32 orders[], fmi3Float64 values[], size_t n)
{
    ignored(r, orders, values, n);
    return status(i, count == 0u, "outputs have no derivatives");
}

EXPORT fmi3Status FMI(DoStep)(fmi3Instance i, fmi3Float64 time, fmi3Float64 duration, fmi3Boolean no_set,
                              fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early_return,
                              fmi3Float64 *last_time)
{
    Model *model = &((Instance *)i)->model;
    const char *wrong = stepped(model, time, duration);
    ignored(i, no_set);
    *event = *terminate = *early_return = false;
    *last_time = (wrong == NULL) ? model->values[TIME] : time;
    return status(i, wrong == NULL, wrong);
}

EXPORT fmi3Status FMI(ActivateModelPartition)(fmi3Instance i, fmi3ValueReference clock, fmi3Float64 time)
{
    ignored(i, clock, time);
    return failed(i, "there are no clocks");
}
