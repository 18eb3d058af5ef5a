// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/study/study_part.h"

#include "cli/shell/forms.h"
#include "cli/shell/output_file.h"
#include "cli/shell/print.h"
#include "session/precision/study_part.h"

/// Writes how many points the part has, for people.
static void put_part_text(hn_strbuf *b, const hn_args *args, const hn_study *study) {
    const hn_wp *wp = hn_study_wp(study);
    int n[HN_WP_STATES] = {0}, mine = 0;
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = 0; k < wp->n_levels; k++) {
            if (hn_wp_is_mine(wp, m, k)) {
                n[wp->methods[m].point[k].state]++;
                mine++;
            }
        }
    }
    hn_strbuf_printf(b, "Part %d of %d: %d points of %d", wp->opts.shard, wp->opts.n_shards, mine,
                     wp->n_methods * wp->n_levels);
    for (int state = 0; state < HN_WP_STATES; state++) {
        if (n[state] > 0) {
            hn_strbuf_printf(b, ", %d %s", n[state], hn_wp_state_name((hn_wp_state)state));
        }
    }
    hn_strbuf_printf(b, "; in %s\n", args->out);
}

/// Writes a part of a study to its file, or to standard output.
hn_exit hn_write_part(const hn_args *args, const hn_study *study) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_study_part(&b, study);
    hn_exit written = hn_cli_write_file(args, args->out, &b);
    if (args->out && written == HN_EXIT_DONE) {
        if (args->json) {
            hn_study_part(&b, study);
        } else {
            put_part_text(&b, args, study);
        }
        written = hn_cli_print(&b);
    }
    return written;
}

hn_status hn_part_check(const hn_args *args, hn_diags *diags) {
    if (args->csv || (args->out && !hn_path_ends_in(args->out, ".json"))) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/out",
                            "take --out FILE.json, then holonom merge FILE.json...",
                            "a part of a study is written as JSON; 'holonom merge' makes a table "
                            "or a report of all parts");
    }
    return HN_OK;
}
