// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands/error_advice.h"

#include "cli/shell/document.h"
#include "integrators/method/method_spec.h"

#include <stdbool.h>
#include <string.h>

/// Returns whether a remedy is the same method with another step or tolerance: "h=0.005",
/// "rtol=1e-08".
static bool is_finer(const char *remedy) {
    return strncmp(remedy, "h=", 2) == 0 || strncmp(remedy, "rtol=", 5) == 0;
}

/// Returns whether a finer step was tried against the incident and removed it.
static bool removed_by_finer(const cJSON *incident) {
    const cJSON *tried = hn_document_get(incident, "tried")->child, *remedy;
    cJSON_ArrayForEach(remedy, hn_document_get(incident, "remedies")) {
        const char *said = tried ? tried->valuestring : "";
        if (is_finer(remedy->valuestring) && strncmp(said, "tried until", 11) == 0) {
            return true;
        }
        tried = tried ? tried->next : NULL;
    }
    return false;
}

/// Returns whether a finer step was tried against the incident and did not remove it.
static bool kept_by_finer(const cJSON *incident) {
    const char *vain = strstr(hn_document_text(incident, "message"), "tried in vain");
    return vain && (strstr(vain, " h=") || strstr(vain, " rtol="));
}

const char *hn_error_advice(const cJSON *run, const cJSON *incidents, int method) {
    hn_method_spec spec;
    hn_diag diag = {0};
    const bool known = hn_method_parse(hn_document_text(run, "method"), &spec, &diag) == HN_OK;
    const bool adaptive = known && hn_method_is_adaptive(&spec);

    // the equations of a counter-example are wrong at any step
    if (known && (spec.formulation->traits & HN_TRAIT_COUNTER_EXAMPLE)) {
        return adaptive ? "; a smaller tolerance does not help: the error lies in the equations of "
                          "the formulation"
                        : "; a smaller step does not help: the error lies in the equations of the "
                          "formulation";
    }

    // what was tried; a trial in vain counts more than one that helped against another incident
    const cJSON *incident;
    bool removed = false, kept = false;
    cJSON_ArrayForEach(incident, incidents) {
        if (method < 0 || (int)hn_document_number(incident, "method") == method) {
            removed |= removed_by_finer(incident);
            kept |= kept_by_finer(incident);
        }
    }
    return !removed || kept ? ""
           : adaptive       ? "; a smaller tolerance may help"
                            : "; a smaller step may help";
}
