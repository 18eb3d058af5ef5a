// SPDX-License-Identifier: GPL-3.0-or-later
// A scene: loaded, compiled, assembled, described, dragged, and run by two methods.
#include "fuzz/fuzz.h"

#include "session/compare/comparison.h"
#include "session/model/drag_json.h"
#include "session/model/inspect_json.h"
#include "session/model/model_json.h"
#include "session/model/terms_json.h"

#include <stdlib.h>

static const char *const METHODS[] = {"index1@rk4:h=1e-2",    "projection@rk4:h=1e-2",
                                      "nullspace@rk4:h=1e-2", "reduced@dopri5:rtol=1e-6",
                                      "ggl@radau5:rtol=1e-4", "index3@genalpha:h=1e-2",
                                      "penalty@rk4:h=1e-2",   "baumgarte@rk4:h=1e-2"};
enum { N_METHODS = sizeof METHODS / sizeof *METHODS, FRAMES = 3, MOST_STEPS = 50 };

static void compare(const hn_model *model, size_t choice) {
    const char *const two[] = {METHODS[choice % N_METHODS],
                               METHODS[choice / N_METHODS % N_METHODS]};
    hn_comparison_opts opts = hn_comparison_opts_default();
    opts.cpu_limit = 0.05;
    opts.max_steps = MOST_STEPS;
    hn_comparison *c = NULL;
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (hn_comparison_create(model, two, 2, &opts, &c, &diags) != HN_OK) {
        return;
    }
    for (int k = 0; k < FRAMES && !hn_comparison_finished(c); k++) {
        hn_comparison_next(c);
        hn_comparison_frame_json(&b, c);
        hn_fuzz_take_json(&b);
        hn_comparison_extra_json(&b, c, HN_FRAME_LAMBDA);
        hn_fuzz_take_json(&b);
    }
    hn_comparison_summary_json(&b, c);
    hn_fuzz_take_json(&b);
    hn_comparison_free(c);
}

/// The documents of a model; one that is refused leaves nothing behind.
static void describe(const hn_model *model) {
    hn_strbuf b;
    hn_diags diags = {0};
    hn_strbuf_init(&b);
    hn_model_json(&b, model);
    hn_fuzz_take_json(&b);
    if (hn_model_inspect_json(&b, model, &diags) == HN_OK) {
        hn_fuzz_take_json(&b);
    }
    hn_strbuf_reset(&b);
    if (hn_model_terms_json_with_reactions(&b, model, 0, NULL, 0, &diags) == HN_OK) {
        hn_fuzz_take_json(&b);
    }
    hn_strbuf_reset(&b);
}

static void drag(const hn_model *model) {
    static const double target[] = {0.3, -0.2};
    const hn_drag_request request = {.target = target, .n_target = 2, .seconds = 0.01};
    hn_strbuf b;
    hn_diags diags = {0};
    hn_strbuf_init(&b);
    if (hn_model_drag_json(&b, model, &request, &diags) == HN_OK) {
        hn_fuzz_take_json(&b);
    }
    hn_strbuf_reset(&b);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *text = hn_fuzz_text(data, size);
    const hn_model_source source = {.text = text, .n_text = size, .id = "fuzz", .allow_open = 1};
    hn_model *model = NULL;
    hn_diags diags = {0};
    const hn_status status = hn_model_load(NULL, &source, &model, &diags);
    hn_fuzz_check(status, &diags);
    if (status == HN_OK) {
        describe(model);
        if (!hn_model_why_open(model)) {
            drag(model);
            compare(model, size);
        }
        hn_model_free(model);
    }
    free(text);
    return 0;
}
