// SPDX-License-Identifier: GPL-3.0-or-later
// Figures that programs written by hand for one mechanism at a time printed for the methods of this
// one, measured again. Prints the table that is kept in figures.txt; arguments choose topics by a
// part of their name. Fails when a figure is not met.
#include "support/figures.h"

#include <stdio.h>
#include <string.h>

typedef struct tally {
    int rows, out, differ;
} tally;

static void print(void *user, const hn_figure_result *r) {
    tally *t = user;
    t->rows++;
    t->out += !r->good;
    t->differ += r->good && strncmp(r->verdict, "differs", 7) == 0;
    printf("  %-52s %-18s %-18s %s\n      %s\n", r->what, r->printed, r->found, r->verdict, r->how);
    (void)fflush(stdout);
}

static int is_wanted(const char *name, int n, char **parts) {
    for (int i = 0; i < n; i++) {
        if (strstr(name, parts[i])) {
            return 1;
        }
    }
    return n == 0;
}

int main(int argc, char **argv) {
    tally t = {0};
    printf(
        "Figures of hand-written programs and of the literature, measured again\n\n  %-52s %-18s "
        "%-18s %s\n",
        "figure", "printed", "found", "verdict, and how it was run");
    for (int i = 0; i < hn_figure_topic_count(); i++) {
        const hn_figure_topic *topic = hn_figure_topic_at(i);
        if (is_wanted(topic->name, argc - 1, argv + 1)) {
            printf("\n%s (%s)\n", topic->name, topic->source);
            hn_figure_topic_run(topic, print, &t);
        }
    }
    printf("\n%d figures: %d met, %d differ with a reason, %d out\n", t.rows,
           t.rows - t.out - t.differ, t.differ, t.out);
    return t.out > 0 || t.rows == 0;
}
