// SPDX-License-Identifier: GPL-3.0-or-later
// A submission for a shipped exercise; the same bytes as an exercise of a teacher's.
#include "fuzz/fuzz.h"

#include "grade/exercise.h"
#include "grade/exercise_shelf.h"
#include "grade/exercise_text.h"
#include "grade/grade.h"

#include <stdlib.h>

static void grade(const hn_exercise *exercise, const char *text, size_t n) {
    hn_verdict *verdict = calloc(1, sizeof *verdict);
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (verdict && hn_grade_json(exercise, text, n, 0, verdict) == HN_OK) {
        hn_verdict_text(&b, verdict);
        hn_strbuf_reset(&b);
        hn_verdict_json(&b, verdict);
        hn_fuzz_take_json(&b);
        hn_verdict_gradescope(&b, verdict, 0.1);
        hn_fuzz_take_json(&b);
    }
    free(verdict);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static hn_exercise *shipped;
    hn_diags diags = {0};
    if (!shipped && hn_shelf_exercise_load(hn_fuzz_library(), "p3", &shipped, &diags) != HN_OK) {
        hn_fuzz_fail("no exercise: %s", diags.item[0].message);
    }
    char *text = hn_fuzz_text(data, size);
    grade(shipped, text, size);

    hn_exercise *own = NULL;
    if (hn_exercise_load_json(text, size, &own, &diags) == HN_OK) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_exercise_json(&b, own, 0, NULL);
        hn_fuzz_take_json(&b);
        hn_exercise_text(&b, own, 0, NULL);
        hn_strbuf_reset(&b);
        hn_exercise_free(own);
    }
    free(text);
    return 0;
}
