// SPDX-License-Identifier: GPL-3.0-or-later
// The verdict on a method, by cases that the test of the page reads too.
#include "support/near.h"

#include "session/verdict/verdict.h"
#include "study/incidents/kinds.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 13 };

static cJSON *read_cases(void) {
    FILE *file = fopen("tests/support/verdicts.json", "rb");
    assert_non_null(file);
    char *text = calloc(1, 1 << 16);
    assert_non_null(text);
    assert_true(fread(text, 1, (1 << 16) - 1, file) > 0);
    fclose(file);
    cJSON *document = cJSON_Parse(text);
    assert_non_null(document);
    free(text);
    return document;
}

static void read_column(const cJSON *one, const char *name, double out[FRAMES]) {
    const cJSON *column = cJSON_GetObjectItem(one, name);
    assert_int_equal(cJSON_GetArraySize(column), FRAMES);
    for (int k = 0; k < FRAMES; k++) {
        const cJSON *value = cJSON_GetArrayItem(column, k);
        out[k] = cJSON_IsNumber(value) ? value->valuedouble : (double)NAN;
    }
}

static double number(const cJSON *one, const char *name, double otherwise) {
    const cJSON *item = cJSON_GetObjectItem(one, name);
    return cJSON_IsNumber(item) ? item->valuedouble : otherwise;
}

/// The name of an incident by its code; NULL: there is none.
static const char *cause_of(const cJSON *one) {
    const char *code = cJSON_GetStringValue(cJSON_GetObjectItem(one, "cause"));
    const hn_incident_kind *const *kinds = hn_incident_kinds();
    for (int i = 0; code && i < HN_INCIDENT_COUNT; i++) {
        if (strcmp(kinds[i]->spelling, code) == 0) {
            return kinds[i]->name;
        }
    }
    return NULL;
}

static void every_shared_case_has_its_words_tone_and_arrow(void **state) {
    (void)state;
    static const char *const tones[] = {"calm", "warn", "bad"};
    cJSON *document = read_cases();
    const cJSON *one;
    int n = 0;
    cJSON_ArrayForEach(one, cJSON_GetObjectItem(document, "cases")) {
        double gap[FRAMES], off[FRAMES], energy[FRAMES];
        read_column(one, "gap", gap);
        read_column(one, "off", off);
        read_column(one, "energy", energy);
        const int shown = (int)number(one, "shown", FRAMES - 1);
        const hn_motion_history history = {
            .gap = gap,
            .off = off,
            .energy = energy,
            .shown = shown,
            .t = shown,
            .ended = number(one, "ended", (double)NAN),
            .cause = cause_of(one),
            .length = number(one, "length", 1),
            .energy_scale = number(one, "energy_scale", 10),
            .digits = number(one, "digits", 12.4),
            .loops = !cJSON_IsFalse(cJSON_GetObjectItem(one, "loops")),
            .asked = cJSON_IsTrue(cJSON_GetObjectItem(one, "asked"))};

        // what the page says too
        const hn_motion_verdict v = hn_motion_judge(&history);
        print_message("%s\n", cJSON_GetStringValue(cJSON_GetObjectItem(one, "name")));
        assert_string_equal(v.text, cJSON_GetStringValue(cJSON_GetObjectItem(one, "text")));
        assert_string_equal(tones[v.tone], cJSON_GetStringValue(cJSON_GetObjectItem(one, "tone")));
        assert_string_equal(v.arrow, cJSON_GetStringValue(cJSON_GetObjectItem(one, "arrow")));
        n++;
    }
    assert_true(n > 20);
    cJSON_Delete(document);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_shared_case_has_its_words_tone_and_arrow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
