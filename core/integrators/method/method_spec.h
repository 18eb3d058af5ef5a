// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_METHOD_SPEC_H
#define HN_INTEGRATORS_METHOD_SPEC_H
// The spelling of a method: FORMULATION[:key=value,...]@INTEGRATOR[:key=value,...]

#include "base/diag.h"
#include "base/strbuf.h"
#include "formulations/ground/formulation.h"
#include "integrators/step/stepper.h"

#include <stdbool.h>

enum { HN_SPEC_MAX = 256 };

typedef struct hn_method_spec {
    const hn_formulation *formulation;
    const hn_stepper *stepper;
    double formulation_set[HN_MAX_OPTIONS]; ///< in table order, defaults filled in
    double stepper_set[HN_MAX_OPTIONS];
} hn_method_spec;

/// Parses and checks. Faults (HN_ERR_INPUT): unknown formulation, integrator or key with a near
/// miss, a value that is no number ("2e-2 s", "20 ms" and "0,02" are read as 0.02), out of range,
/// given twice, missing '@', an integrator that does not serve the formulation. `diag->column` says
/// where. With HN_OK, diag->message is "" or a warning ("alpha = -5 1/s: below zero it pushes the
/// loop apart").
/// A spelling that begins with "program:" is that of a guest (integrators/method/guest.h):
/// program:FILE[@INTEGRATOR[:key=value,...]].
HN_MUST_CHECK hn_status hn_method_parse(const char *text, hn_method_spec *out, hn_diag *diag);
/// The normal spelling: only options that differ from their defaults, plus h or rtol (what the step
/// is taken or chosen by) always. Reads back to the same spec.
void hn_method_format(const hn_method_spec *spec, char out[HN_SPEC_MAX]);
/// Returns the place of an option's value, in the formulation or else in the integrator, and its
/// entry in *info (may be NULL). NULL: neither has the option.
double *hn_method_find_option(hn_method_spec *spec, const char *key, const hn_option **info);
/// Returns the value of an option by key; `otherwise` where neither has it.
double hn_method_option(const hn_method_spec *spec, const char *key, double otherwise);
/// The form in which this pair takes the constraints: the formulation's own, or else the one it has
/// also.
hn_dae_form hn_method_form(const hn_formulation *formulation, const hn_stepper *stepper);
/// 1 if the integrator serves what the formulation hands over.
int hn_method_fits(const hn_formulation *formulation, const hn_stepper *stepper);
/// Returns whether the step is chosen from tolerances: the integrator is adaptive and no h > 0
/// fixes it.
bool hn_method_is_adaptive(const hn_method_spec *spec);
/// Checks one value against its table entry: HN_OK or HN_ERR_INPUT with the reason in diag (no
/// column).
HN_MUST_CHECK hn_status hn_option_check(const hn_option *info, double value, hn_diag *diag);
/// Reads one value as hn_method_parse() does ("0,02", "20 ms", "auto"); checked.
HN_MUST_CHECK hn_status hn_option_parse(const hn_option *info, const char *text, double *value,
                                        hn_diag *diag);
/// {"spelling","formulation","integrator","title","short_name","model_error","options":{...}};
/// options of the integrator follow those of the formulation, named choices are strings.
void hn_method_json(hn_strbuf *b, const hn_method_spec *spec);
#endif
