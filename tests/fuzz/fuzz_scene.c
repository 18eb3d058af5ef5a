// SPDX-License-Identifier: GPL-3.0-or-later
// A scene: loaded, compiled and assembled, then described, dragged, or run by a method. The input
// chooses one of these, so that an input costs little; a large mechanism is only loaded.
#include "fuzz/fuzz.h"

#include "session/compare/comparison_doc.h"
#include "session/model/drag_json.h"
#include "session/model/inspect_json.h"
#include "session/model/model_json.h"
#include "session/model/terms_json.h"

#include <stdlib.h>

static const char *const METHODS[] = {"index1@rk4:h=1e-2",    "projection@rk4:h=1e-2",
                                      "nullspace@rk4:h=1e-2", "reduced@dopri5:rtol=1e-6",
                                      "ggl@radau5:rtol=1e-4", "index3@genalpha:h=1e-2",
                                      "penalty@rk4:h=1e-2",   "baumgarte@rk4:h=1e-2"};
enum { N_METHODS = sizeof METHODS / sizeof *METHODS, FRAMES = 3, MOST_STEPS = 50, MOST_BODIES = 6 };

static void compare(const hn_model *model, unsigned choice) {
    const char *const one[] = {METHODS[choice % N_METHODS]};
    hn_comparison_opts opts = hn_comparison_opts_default();
    opts.cpu_limit = 0.05;
    opts.max_steps = MOST_STEPS;
    hn_comparison *c = NULL;
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (hn_comparison_create(model, one, 1, &opts, &c, &diags) != HN_OK) {
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

static void describe(const hn_model *model, unsigned choice) {
    hn_strbuf b;
    (void)choice;
    hn_strbuf_init(&b);
    hn_model_json(&b, model);
    hn_fuzz_take_json(&b);
}

/// A document that is refused leaves nothing behind.
static void inspect(const hn_model *model, unsigned choice) {
    hn_strbuf b;
    hn_diags diags = {0};
    (void)choice;
    hn_strbuf_init(&b);
    if (hn_model_inspect_json(&b, model, &diags) == HN_OK) {
        hn_fuzz_take_json(&b);
    }
    hn_strbuf_reset(&b);
}

static void write_terms(const hn_model *model, unsigned choice) {
    hn_strbuf b;
    hn_diags diags = {0};
    (void)choice;
    hn_strbuf_init(&b);
    if (hn_model_terms_json_with_reactions(&b, model, 0, NULL, 0, &diags) == HN_OK) {
        hn_fuzz_take_json(&b);
    }
    hn_strbuf_reset(&b);
}

static void drag(const hn_model *model, unsigned choice) {
    static const double target[] = {0.3, -0.2};
    const hn_drag_request request = {.target = target, .n_target = 2, .seconds = 0.01};
    hn_strbuf b;
    hn_diags diags = {0};
    (void)choice;
    hn_strbuf_init(&b);
    if (hn_model_drag_json(&b, model, &request, &diags) == HN_OK) {
        hn_fuzz_take_json(&b);
    }
    hn_strbuf_reset(&b);
}

/// The uses of a model that was loaded; the last two need one that is closed.
static void (*const USES[])(const hn_model *model, unsigned choice) = {describe, inspect,
                                                                       write_terms, drag, compare};
enum { N_USES = sizeof USES / sizeof *USES, N_OPEN_USES = 3 };

static void use(const hn_model *model, const uint8_t *data, size_t size) {
    unsigned choice = 0;
    for (size_t i = 0; i < size; i++) {
        choice = 31 * choice + data[i];
    }
    if (hn_model_scene(model)->n_bodies <= MOST_BODIES) {
        const unsigned uses = hn_model_why_open(model) ? N_OPEN_USES : N_USES;
        USES[choice % uses](model, choice / uses);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *text = hn_fuzz_text(data, size);
    const hn_model_source source = {.text = text, .n_text = size, .id = "fuzz", .allow_open = 1};
    hn_model *model = NULL;
    hn_diags diags = {0};
    const hn_status status = hn_model_load(NULL, &source, &model, &diags);
    hn_fuzz_check(status, &diags);
    if (status == HN_OK) {
        use(model, data, size);
        hn_model_free(model);
    }
    free(text);
    return 0;
}
