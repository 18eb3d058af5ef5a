// SPDX-License-Identifier: GPL-3.0-or-later
// The spelling of a method: its normal form reads back to itself.
#include "fuzz/fuzz.h"

#include "integrators/method/method_spec.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *text = hn_fuzz_text(data, size), once[HN_SPEC_MAX], twice[HN_SPEC_MAX];
    hn_method_spec spec;
    hn_diag diag = {0};
    if (hn_method_parse(text, &spec, &diag) == HN_OK) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_method_json(&b, &spec);
        hn_fuzz_take_json(&b);
        hn_method_format(&spec, once);
        if (hn_method_parse(once, &spec, &diag) != HN_OK) {
            hn_fuzz_fail("the normal form of '%s' is refused: '%s': %s", text, once, diag.message);
        }
        hn_method_format(&spec, twice);
        if (strcmp(once, twice) != 0) {
            hn_fuzz_fail("the normal form is not normal: '%s', '%s'", once, twice);
        }
    }
    free(text);
    return 0;
}
