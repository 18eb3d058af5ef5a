// SPDX-License-Identifier: GPL-3.0-or-later
// A kept reference: the object in its file. Every object that is taken is whole and finite, and
// is written again.
#include "fuzz/fuzz.h"

#include "session/model/model.h"
#include "session/references/reference_store.h"
#include "session/store/stored_json.h"

#include <math.h>
#include <stdio.h>

static hn_model *model;
static char path[512];

static void prepare(void) {
    const hn_model_source source = {.name = "pendulum"};
    hn_diags diags = {0};
    if (hn_model_load(hn_fuzz_library(), &source, &model, &diags) != HN_OK) {
        hn_fuzz_fail("%s", diags.item[0].message);
    }
    snprintf(path, sizeof path, "%s/reference.json", hn_fuzz_folder());
}

static void check(const hn_ref *ref) {
    const size_t n = ((size_t)ref->n + 1) * (size_t)ref->n_user;
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(ref->q[i]) || !isfinite(ref->v[i])) {
            hn_fuzz_fail("a reference that is not finite was taken");
        }
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_reference_put(&b, model, ref);
    hn_fuzz_take_json(&b);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (!model) {
        prepare();
    }
    hn_fuzz_write(path, data, size);
    cJSON *object = hn_stored_open(path);
    hn_ref *ref = hn_reference_take(object, model, (double)NAN, HN_REF_TIMES);
    if (ref) {
        check(ref);
        hn_ref_free(ref);
    }
    cJSON_Delete(object);
    return 0;
}
