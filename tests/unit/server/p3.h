// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TESTS_P3_H
#define HN_TESTS_P3_H
// Problem 3 of lesson 1, the Jacobian of the four-bar, for tests that grade it.

#include "grade/grade.h"

#include "support/near.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

#define P3 "lessons/01-closed-loops/problems/p3.json"

// the lesson's own result, section 5
static const char *const RIGHT[8] = {"-l1*sin(th1)", "-l2*sin(th2)", "l3*sin(th3)",
                                     "l4*sin(th4)",  "l1*cos(th1)",  "l2*cos(th2)",
                                     "-l3*cos(th3)", "-l4*cos(th4)"};

static inline hn_exercise *load_p3(void) {
    hn_exercise *p = NULL;
    hn_diags diags = {0};
    if (hn_exercise_load_file(P3, &p, &diags) != HN_OK) {
        fail_msg("%s: %s", diags.item[0].pointer, diags.item[0].message);
    }
    return p;
}

static inline int setup(void **state) {
    *state = load_p3();
    return 0;
}

static inline int teardown(void **state) {
    hn_exercise_free(*state);
    return 0;
}

static inline void grade(const hn_exercise *p, const char *text, hn_verdict *v) {
    memset(v, 0x5A, sizeof *v);
    assert_int_equal(hn_grade_json(p, text, strlen(text), 0, v), HN_OK);
}

/// Grades the right answer with entry `k` (0..7) replaced.
static inline void grade_with(const hn_exercise *p, int k, const char *formula, hn_verdict *v) {
    char text[8192];
    size_t at = 0;
    for (int i = 0; i < 8; i++) {
        at += (size_t)snprintf(text + at, sizeof text - at, "%s\"%s\"",
                               i == 0   ? "{\"J\": [["
                               : i == 4 ? "], ["
                                        : ", ",
                               i == k ? formula : RIGHT[i]);
    }
    snprintf(text + at, sizeof text - at, "]]}");
    grade(p, text, v);
}

/// Parses the document and empties the buffer.
static inline cJSON *parse(hn_strbuf *b) {
    cJSON *root = cJSON_Parse(hn_strbuf_text(b));
    assert_non_null(root);
    hn_strbuf_reset(b);
    return root;
}

static inline double number_of(const cJSON *node, const char *key) {
    const cJSON *m = cJSON_GetObjectItemCaseSensitive(node, key);
    assert_true(cJSON_IsNumber(m));
    return m->valuedouble;
}

#endif
