/* What importers want to see exported and a shaper has no use for: refused, with a sentence.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "preshape_fmu.h"

static fmi3Status refused(fmi3Instance instance) {
    return preshape_say((const preshape_instance *)instance, fmi3Error,
                        "this FMU does not support that function; see the capabilities in its modelDescription.xml.");
}

/* No variable has such a type; asking for none of them is right. */
static fmi3Status none(fmi3Instance instance, size_t count) {
    return (count == 0u) ? fmi3OK
                         : preshape_say((const preshape_instance *)instance, fmi3Error,
                                        "there is no variable of this type: command, shaped and initial are Float64, "
                                        "pass_not_finite is Boolean.");
}

#define NO_VARIABLES(Type)                                                                                             \
    FMI3_API fmi3Status FMI3(Get##Type)(fmi3Instance instance, const fmi3ValueReference references[], size_t count,    \
                                        fmi3##Type values[], size_t size) {                                            \
        (void)references;                                                                                              \
        (void)values;                                                                                                  \
        (void)size;                                                                                                    \
        return none(instance, count);                                                                                  \
    }                                                                                                                  \
    FMI3_API fmi3Status FMI3(Set##Type)(fmi3Instance instance, const fmi3ValueReference references[], size_t count,    \
                                        const fmi3##Type values[], size_t size) {                                      \
        (void)references;                                                                                              \
        (void)values;                                                                                                  \
        (void)size;                                                                                                    \
        return none(instance, count);                                                                                  \
    }

NO_VARIABLES(Float32)
NO_VARIABLES(Int8)
NO_VARIABLES(UInt8)
NO_VARIABLES(Int16)
NO_VARIABLES(UInt16)
NO_VARIABLES(Int32)
NO_VARIABLES(UInt32)
NO_VARIABLES(Int64)
NO_VARIABLES(UInt64)
NO_VARIABLES(String)

FMI3_API fmi3Status FMI3(GetBinary)(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                    size_t sizes[], fmi3Binary values[], size_t size) {
    (void)references;
    (void)sizes;
    (void)values;
    (void)size;
    return none(instance, count);
}

FMI3_API fmi3Status FMI3(SetBinary)(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                    const size_t sizes[], const fmi3Binary values[], size_t size) {
    (void)references;
    (void)sizes;
    (void)values;
    (void)size;
    return none(instance, count);
}

FMI3_API fmi3Status FMI3(GetClock)(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                   fmi3Clock values[]) {
    (void)references;
    (void)values;
    return none(instance, count);
}

FMI3_API fmi3Status FMI3(SetClock)(fmi3Instance instance, const fmi3ValueReference references[], size_t count,
                                   const fmi3Clock values[]) {
    (void)references;
    (void)values;
    return none(instance, count);
}

/* Functions that are refused whatever they are given. */
#define REFUSED(name, parameters, unused)                                                                              \
    FMI3_API fmi3Status FMI3(name) parameters {                                                                        \
        unused;                                                                                                        \
        return refused(instance);                                                                                      \
    }

#define U(x) (void)(x)

REFUSED(EnterEventMode, (fmi3Instance instance), (void)0)
REFUSED(EnterStepMode, (fmi3Instance instance), (void)0)
REFUSED(EnterConfigurationMode, (fmi3Instance instance), (void)0)
REFUSED(ExitConfigurationMode, (fmi3Instance instance), (void)0)
REFUSED(EvaluateDiscreteStates, (fmi3Instance instance), (void)0)
REFUSED(UpdateDiscreteStates,
        (fmi3Instance instance, fmi3Boolean *again, fmi3Boolean *terminate, fmi3Boolean *nominals, fmi3Boolean *values,
         fmi3Boolean *defined, fmi3Float64 *next),
        (U(again), U(terminate), U(nominals), U(values), U(defined), U(next)))
REFUSED(GetNumberOfVariableDependencies, (fmi3Instance instance, fmi3ValueReference reference, size_t *count),
        (U(reference), U(count)))
REFUSED(GetVariableDependencies,
        (fmi3Instance instance, fmi3ValueReference dependent, size_t elements[], fmi3ValueReference independents[],
         size_t independent_elements[], fmi3DependencyKind kinds[], size_t count),
        (U(dependent), U(elements), U(independents), U(independent_elements), U(kinds), U(count)))
REFUSED(GetDirectionalDerivative,
        (fmi3Instance instance, const fmi3ValueReference unknowns[], size_t count, const fmi3ValueReference knowns[],
         size_t known, const fmi3Float64 seed[], size_t seeds, fmi3Float64 sensitivity[], size_t sensitivities),
        (U(unknowns), U(count), U(knowns), U(known), U(seed), U(seeds), U(sensitivity), U(sensitivities)))
REFUSED(GetAdjointDerivative,
        (fmi3Instance instance, const fmi3ValueReference unknowns[], size_t count, const fmi3ValueReference knowns[],
         size_t known, const fmi3Float64 seed[], size_t seeds, fmi3Float64 sensitivity[], size_t sensitivities),
        (U(unknowns), U(count), U(knowns), U(known), U(seed), U(seeds), U(sensitivity), U(sensitivities)))
REFUSED(GetOutputDerivatives,
        (fmi3Instance instance, const fmi3ValueReference references[], size_t count, const fmi3Int32 orders[],
         fmi3Float64 values[], size_t size),
        (U(references), U(count), U(orders), U(values), U(size)))
REFUSED(GetIntervalDecimal,
        (fmi3Instance instance, const fmi3ValueReference references[], size_t count, fmi3Float64 intervals[],
         fmi3IntervalQualifier qualifiers[]),
        (U(references), U(count), U(intervals), U(qualifiers)))
REFUSED(GetIntervalFraction,
        (fmi3Instance instance, const fmi3ValueReference references[], size_t count, fmi3UInt64 counters[],
         fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[]),
        (U(references), U(count), U(counters), U(resolutions), U(qualifiers)))
REFUSED(GetShiftDecimal,
        (fmi3Instance instance, const fmi3ValueReference references[], size_t count, fmi3Float64 shifts[]),
        (U(references), U(count), U(shifts)))
REFUSED(GetShiftFraction,
        (fmi3Instance instance, const fmi3ValueReference references[], size_t count, fmi3UInt64 counters[],
         fmi3UInt64 resolutions[]),
        (U(references), U(count), U(counters), U(resolutions)))
REFUSED(SetIntervalDecimal,
        (fmi3Instance instance, const fmi3ValueReference references[], size_t count, const fmi3Float64 intervals[]),
        (U(references), U(count), U(intervals)))
REFUSED(SetIntervalFraction,
        (fmi3Instance instance, const fmi3ValueReference references[], size_t count, const fmi3UInt64 counters[],
         const fmi3UInt64 resolutions[]),
        (U(references), U(count), U(counters), U(resolutions)))
REFUSED(SetShiftDecimal,
        (fmi3Instance instance, const fmi3ValueReference references[], size_t count, const fmi3Float64 shifts[]),
        (U(references), U(count), U(shifts)))
REFUSED(SetShiftFraction,
        (fmi3Instance instance, const fmi3ValueReference references[], size_t count, const fmi3UInt64 counters[],
         const fmi3UInt64 resolutions[]),
        (U(references), U(count), U(counters), U(resolutions)))

REFUSED(EnterContinuousTimeMode, (fmi3Instance instance), (void)0)
REFUSED(CompletedIntegratorStep,
        (fmi3Instance instance, fmi3Boolean no_way_back, fmi3Boolean *event_mode, fmi3Boolean *terminate),
        (U(no_way_back), U(event_mode), U(terminate)))
REFUSED(SetTime, (fmi3Instance instance, fmi3Float64 time), U(time))
REFUSED(SetContinuousStates, (fmi3Instance instance, const fmi3Float64 states[], size_t count), (U(states), U(count)))
REFUSED(GetContinuousStateDerivatives, (fmi3Instance instance, fmi3Float64 derivatives[], size_t count),
        (U(derivatives), U(count)))
REFUSED(GetEventIndicators, (fmi3Instance instance, fmi3Float64 indicators[], size_t count),
        (U(indicators), U(count)))
REFUSED(GetContinuousStates, (fmi3Instance instance, fmi3Float64 states[], size_t count), (U(states), U(count)))
REFUSED(GetNominalsOfContinuousStates, (fmi3Instance instance, fmi3Float64 nominals[], size_t count),
        (U(nominals), U(count)))
REFUSED(GetNumberOfEventIndicators, (fmi3Instance instance, size_t *count), U(count))
REFUSED(GetNumberOfContinuousStates, (fmi3Instance instance, size_t *count), U(count))
REFUSED(ActivateModelPartition, (fmi3Instance instance, fmi3ValueReference clock, fmi3Float64 time),
        (U(clock), U(time)))

FMI3_API fmi3Instance FMI3(InstantiateModelExchange)(fmi3String name, fmi3String token, fmi3String resources,
                                                     fmi3Boolean visible, fmi3Boolean logging,
                                                     fmi3InstanceEnvironment environment, fmi3LogMessageCallback log) {
    U(name), U(token), U(resources), U(visible), U(logging), U(environment), U(log);
    return NULL;
}

FMI3_API fmi3Instance FMI3(InstantiateScheduledExecution)(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3ClockUpdateCallback update,
    fmi3LockPreemptionCallback lock, fmi3UnlockPreemptionCallback unlock) {
    U(name), U(token), U(resources), U(visible), U(logging), U(environment), U(log), U(update), U(lock), U(unlock);
    return NULL;
}
