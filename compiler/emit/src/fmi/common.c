#ifdef FMIN_FUNCTION_PREFIX
#define PASTED(prefix, name) prefix##name
#define WITH_PREFIX(prefix, name) PASTED(prefix, name)
#define FMI(name) WITH_PREFIX(FMIN_FUNCTION_PREFIX, fmiN##name)
#else
#define FMI(name) fmiN##name
#endif

static fmiNStatus failed(INSTANCE i, const char *message);

static fmiNStatus status(INSTANCE i, int is_ok, const char *message)
{
    return is_ok ? fmiNOK : failed(i, message);
}

// Changes of mode that need no work.
#define MODE(name) \
    EXPORT fmiNStatus FMI(name)(INSTANCE i) \
    { \
        return i == NULL ? fmiNError : fmiNOK; \
    }
MODE(ExitInitializationMode)
MODE(EnterEventMode)
MODE(EnterContinuousTimeMode)
MODE(Terminate)

EXPORT fmiNStatus FMI(SetDebugLogging)(INSTANCE i, fmiNBoolean on, size_t count, const fmiNString categories[])
{
    ignored(i, on, count, categories);
    return fmiNOK;
}

EXPORT fmiNStatus FMI(CompletedIntegratorStep)(INSTANCE i, fmiNBoolean no_set, fmiNBoolean *enter_event_mode,
                                               fmiNBoolean *terminate)
{
    ignored(i, no_set);
    *enter_event_mode = *terminate = 0;
    return fmiNOK;
}

OWN_FUNCTIONS
EXPORT void FMI(FreeInstance)(INSTANCE i)
{
    free(i);
}

EXPORT fmiNStatus FMI(Reset)(INSTANCE i)
{
    restart(&((Instance *)i)->model);
    return fmiNOK;
}

EXPORT fmiNStatus FMI(GetFMU_STATE)(INSTANCE i, STATE_TYPE *state)
{
    if (*state == NULL) {
        *state = malloc(sizeof(Model));
    }
    if (*state == NULL) {
        return failed(i, "there is no memory for the state");
    }
    memcpy(*state, &((Instance *)i)->model, sizeof(Model));
    return fmiNOK;
}

EXPORT fmiNStatus FMI(SetFMU_STATE)(INSTANCE i, STATE_TYPE state)
{
    memcpy(&((Instance *)i)->model, state, sizeof(Model));
    return fmiNOK;
}

EXPORT fmiNStatus FMI(FreeFMU_STATE)(INSTANCE i, STATE_TYPE *state)
{
    ignored(i);
    if (state != NULL) {
        free(*state);
        *state = NULL;
    }
    return fmiNOK;
}

EXPORT fmiNStatus FMI(SerializedFMU_STATESize)(INSTANCE i, STATE_TYPE state, size_t *size)
{
    ignored(i, state);
    *size = sizeof(Model);
    return fmiNOK;
}

EXPORT fmiNStatus FMI(SerializeFMU_STATE)(INSTANCE i, STATE_TYPE state, fmiNByte bytes[], size_t size)
{
    if (size < sizeof(Model)) {
        return failed(i, "the state has more bytes");
    }
    memcpy(bytes, state, sizeof(Model));
    return fmiNOK;
}

EXPORT fmiNStatus FMI(DESERIALIZE)(INSTANCE i, const fmiNByte bytes[], size_t size, STATE_TYPE *state)
{
    if (size != sizeof(Model)) {
        return failed(i, "these are not the bytes of a state of this FMU");
    }
    if (FMI(GetFMU_STATE)(i, state) != fmiNOK) {
        return fmiNError;
    }
    memcpy(*state, bytes, size);
    return fmiNOK;
}

EXPORT fmiNStatus FMI(SetTime)(INSTANCE i, REAL time)
{
    ((Instance *)i)->model.values[TIME] = time;
    return fmiNOK;
}

EXPORT fmiNStatus FMI(SetContinuousStates)(INSTANCE i, const REAL x[], size_t count)
{
    Model *model = &((Instance *)i)->model;
    if (count != STATES) {
        return failed(i, "wrong number of states");
    }
    if (count > 0u) {
        memcpy(model->values + Q, x, count * sizeof *x);
        model->is_evaluated = 0;
    }
    return fmiNOK;
}

EXPORT fmiNStatus FMI(GetContinuousStates)(INSTANCE i, REAL x[], size_t count)
{
    if (count != STATES) {
        return failed(i, "wrong number of states");
    }
    if (count > 0u) {
        memcpy(x, ((Instance *)i)->model.values + Q, count * sizeof *x);
    }
    return fmiNOK;
}

EXPORT fmiNStatus FMI(GET_DERIVATIVES)(INSTANCE i, REAL x[], size_t count)
{
    Model *model = &((Instance *)i)->model;
    if (count != STATES) {
        return failed(i, "wrong number of states");
    }
    if (count > 0u) {
        evaluated(model);
        memcpy(x, model->values + QD, count * sizeof *x);
    }
    return status(i, are_finite(x, STATES), "the accelerations are not finite");
}

EXPORT fmiNStatus FMI(GetNominalsOfContinuousStates)(INSTANCE i, REAL x[], size_t count)
{
    size_t k;
    ignored(i);
    for (k = 0; k < count; k++) {
        x[k] = 1.0;
    }
    return fmiNOK;
}
