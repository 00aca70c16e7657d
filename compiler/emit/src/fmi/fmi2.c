typedef struct {
    Model model;
    const fmi2CallbackFunctions *callbacks;
    fmi2String name;
} Instance;

static fmi2Status failed(fmi2Component c, const char *message)
{
    const Instance *instance = c;
    if (instance != NULL && instance->callbacks != NULL && instance->callbacks->logger != NULL) {
        instance->callbacks->logger(instance->callbacks->componentEnvironment, instance->name, fmi2Error, "error",
                                    "%s", message);
    }
    return fmi2Error;
}

static fmi2Status no_variables(fmi2Component c, size_t count)
{
    return status(c, c != NULL && count == 0u, "all variables are of type Real");
}

EXPORT const char *FMI(GetTypesPlatform)(void)
{
    return "default";
}

EXPORT const char *FMI(GetVersion)(void)
{
    return "2.0";
}

EXPORT fmi2Component FMI(Instantiate)(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                                      const fmi2CallbackFunctions *callbacks, fmi2Boolean visible, fmi2Boolean logging)
{
    Instance *instance = calloc(1u, sizeof *instance + (name == NULL ? 0u : strlen(name)) + 1u);
    ignored(resources, type, visible, logging);
    if (instance == NULL) {
        return NULL;
    }
    // the name is behind the instance
    instance->name = (char *)(instance + 1);
    if (name != NULL) {
        memcpy(instance + 1, name, strlen(name));
    }
    instance->callbacks = callbacks;
    restart(&instance->model);
    if (guid == NULL || strcmp(guid, TOKEN) != 0) {
        failed(instance, "the guid is not that of this FMU");
        free(instance);
        return NULL;
    }
    return instance;
}

EXPORT fmi2Status FMI(SetupExperiment)(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                                       fmi2Boolean has_stop, fmi2Real stop)
{
    ignored(c, has_tolerance, tolerance, has_stop, stop);
    ((Instance *)c)->model.values[TIME] = start;
    return fmi2OK;
}

MODE(EnterInitializationMode)

EXPORT fmi2Status FMI(GetReal)(fmi2Component c, const fmi2ValueReference references[], size_t count, fmi2Real values[])
{
    return status(c, get(&((Instance *)c)->model, references, count, values), "no variable has this value reference");
}

EXPORT fmi2Status FMI(SetReal)(fmi2Component c, const fmi2ValueReference references[], size_t count,
                               const fmi2Real values[])
{
    return status(c, set(&((Instance *)c)->model, references, count, values), "this variable cannot be set");
}

// Types of which there are no variables.
#define NO_VARIABLES(name, type) \
    EXPORT fmi2Status FMI(Get##name)(fmi2Component c, const fmi2ValueReference r[], size_t count, type values[]) \
    { \
        ignored(r, values); \
        return no_variables(c, count); \
    } \
    EXPORT fmi2Status FMI(Set##name)(fmi2Component c, const fmi2ValueReference r[], size_t count, \
                                     const type values[]) \
    { \
        ignored(r, values); \
        return no_variables(c, count); \
    }
NO_VARIABLES(Integer, fmi2Integer)
NO_VARIABLES(Boolean, fmi2Boolean)
NO_VARIABLES(String, fmi2String)

EXPORT fmi2Status FMI(GetDirectionalDerivative)(fmi2Component c, const fmi2ValueReference unknowns[], size_t rows,
                                                const fmi2ValueReference knowns[], size_t columns,
                                                const fmi2Real seed[], fmi2Real result[])
{
    return status(c, product(&((Instance *)c)->model, unknowns, rows, knowns, columns, seed, result, 0),
                  "there is no derivative of these variables");
}

EXPORT fmi2Status FMI(NewDiscreteStates)(fmi2Component c, fmi2EventInfo *info)
{
    ignored(c);
    memset(info, 0, sizeof *info);
    return fmi2OK;
}

EXPORT fmi2Status FMI(GetEventIndicators)(fmi2Component c, fmi2Real x[], size_t count)
{
    ignored(x);
    return status(c, count == 0u, "there are no event indicators");
}

EXPORT fmi2Status FMI(SetRealInputDerivatives)(fmi2Component c, const fmi2ValueReference references[], size_t count,
                                               const fmi2Integer orders[], const fmi2Real values[])
{
    ignored(references, orders, values);
    return status(c, count == 0u, "inputs are constant over a step");
}

EXPORT fmi2Status FMI(GetRealOutputDerivatives)(fmi2Component c, const fmi2ValueReference references[], size_t count,
                                                const fmi2Integer orders[], fmi2Real values[])
{
    ignored(references, orders, values);
    return status(c, count == 0u, "outputs have no derivatives");
}

EXPORT fmi2Status FMI(DoStep)(fmi2Component c, fmi2Real time, fmi2Real duration, fmi2Boolean no_set)
{
    const char *wrong = stepped(&((Instance *)c)->model, time, duration);
    ignored(c, no_set);
    return status(c, wrong == NULL, wrong);
}

EXPORT fmi2Status FMI(CancelStep)(fmi2Component c)
{
    return failed(c, "no step is pending");
}

// What is asked of steps that are pending.
#define PENDING(name, type) \
    EXPORT fmi2Status FMI(name)(fmi2Component c, const fmi2StatusKind kind, type *value) \
    { \
        ignored(c, kind, value); \
        return fmi2Discard; \
    }
PENDING(GetStatus, fmi2Status)
PENDING(GetRealStatus, fmi2Real)
PENDING(GetIntegerStatus, fmi2Integer)
PENDING(GetBooleanStatus, fmi2Boolean)
PENDING(GetStringStatus, fmi2String)
