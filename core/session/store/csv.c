// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/store/csv.h"

#include <math.h>

void hn_csv_number(hn_strbuf *b, double value) {
    hn_strbuf number; // a buffer of its own: JSON's commas are not these
    if (!isfinite(value)) {
        return;
    }
    hn_strbuf_init(&number);
    hn_json_number(&number, value);
    hn_strbuf_add(b, hn_strbuf_text(&number));
    b->failed |= number.failed;
    hn_strbuf_reset(&number);
}

void hn_csv_text(hn_strbuf *b, const char *text) {
    hn_strbuf_add(b, "\"");
    for (const char *p = text ? text : ""; *p; p++) {
        hn_strbuf_add_n(b, *p == '"' ? "\"\"" : p, *p == '"' ? 2 : 1);
    }
    hn_strbuf_add(b, "\"");
}
