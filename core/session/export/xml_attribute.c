// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/export/xml_attribute.h"

#include "base/markup.h"
#include "base/shortest.h"

void hn_xml_put_text(hn_strbuf *b, const char *key, const char *text, const char *suffix) {
    hn_strbuf_printf(b, " %s=\"", key);
    hn_html_text(b, text);
    hn_strbuf_printf(b, "%s\"", suffix);
}

void hn_xml_put_numbers(hn_strbuf *b, const char *key, const double *x, int n) {
    hn_strbuf_printf(b, " %s=\"", key);
    for (int i = 0; i < n; i++) {
        char text[HN_SHORTEST_TEXT];
        hn_shortest_write(x[i] + 0.0, text);
        hn_strbuf_printf(b, "%s%s", i ? " " : "", text);
    }
    hn_strbuf_add(b, "\"");
}

void hn_xml_leave_out(hn_strbuf *left_out, const char *what, const char *name, const char *why) {
    hn_strbuf_printf(left_out, "left out: %s%s%s%s: %s\n", what, name ? " '" : "", name ? name : "",
                     name ? "'" : "", why);
}
