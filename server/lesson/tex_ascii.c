// SPDX-License-Identifier: GPL-3.0-or-later
#include "lesson/tex_ascii.h"

#include "lesson/tex_text.h"
#include "terminal/spell_out.h"

void hn_tex_ascii(hn_strbuf *b, const char *tex) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_tex_text(&text, tex);
    hn_spell_out(b, hn_strbuf_text(&text), false);
    hn_strbuf_reset(&text);
}
