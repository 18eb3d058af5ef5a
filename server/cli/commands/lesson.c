// SPDX-License-Identifier: GPL-3.0-or-later
// holonom lesson
#include "lesson/lesson.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/plain.h"
#include "cli/shell/print.h"
#include "lesson/lesson_text.h"
#include "terminal/width.h"

#include <stdlib.h>

enum { WIDEST = 100 };

hn_exit hn_command_lesson(const hn_library *lib, const hn_args *args) {
    cJSON *lesson = NULL;
    hn_diags diags = {0};
    const hn_status status = hn_lesson_load(lib, args->words.word[0], &lesson, &diags);
    if (status != HN_OK) {
        return hn_report_diags(args, status, &diags);
    }
    hn_strbuf b;
    hn_strbuf_init(&b);
    const int columns = hn_terminal_columns();
    if (args->json) {
        hn_lesson_json(&b, lesson);
    } else {
        if (hn_plain_wanted(getenv("LC_ALL"), getenv("LC_CTYPE"), getenv("LANG"))) {
            hn_lesson_spell_out(lesson);
        }
        hn_lesson_text(&b, lesson, columns < WIDEST ? columns : WIDEST);
    }
    cJSON_Delete(lesson);
    return args->json ? hn_cli_print(&b) : hn_cli_print_text(&b);
}
