#ifndef HN_INTEGRATORS_SPEC_H
#define HN_INTEGRATORS_SPEC_H
// The spelling of a method: FORMULATION[:key=value,...]@INTEGRATOR[:key=value,...]

#include "base/diag.h"
#include "base/strbuf.h"
#include "integrators/stepper.h"
#include "methods/method.h"

enum { HN_SPEC_MAX = 256 };

typedef struct hn_method_spec {
    const hn_formulation *formulation;
    const hn_stepper *stepper;
    double formulation_set[HN_MAX_SETTINGS]; ///< in table order, defaults filled in
    double stepper_set[HN_MAX_SETTINGS];
} hn_method_spec;

/// Parses and checks. Faults (HN_ERR_INPUT): unknown formulation, integrator or key with a near miss, a value that is no number
/// ("2e-2 s" and "0,02" are read as 0.02), out of range, given twice, missing '@'. `diag->column` says where.
HN_MUST_CHECK hn_status hn_method_parse(const char *text, hn_method_spec *out, hn_diag *diag);
/// The normal spelling: only settings that differ from their defaults, plus h or rtol always. Reads back to the same spec.
void hn_method_format(const hn_method_spec *spec, char out[HN_SPEC_MAX]);
/// {"spelling","formulation","integrator","title","settings":{...}}
void hn_method_json(hn_strbuf *b, const hn_method_spec *spec);
/// The whole catalogue: {"formulations":[card...],"integrators":[card...]}; settings with unit, range, default.
void hn_methods_json(hn_strbuf *b);
#endif
