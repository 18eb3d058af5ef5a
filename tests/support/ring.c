// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/ring.h"

#include "support/near.h"

#include <stdio.h>
#include <string.h>

// the first joint is the crank; freedoms are the joints' less six (spatial mobility), where no leg
// spins about itself
static const ring RINGS[] = {
    {"RSCR", 4, {"revolute", "spherical", "cylindrical", "revolute"}, 1},
    {"RUSR", 4, {"revolute", "universal", "spherical", "revolute"}, 1},
    {"RCCC", 4, {"revolute", "cylindrical", "cylindrical", "cylindrical"}, 1},
    {"REUR", 4, {"revolute", "planar", "universal", "revolute"}, 1},
    {"RUSP", 4, {"revolute", "universal", "spherical", "prismatic"}, 1},
    {"RSFCR", 5, {"revolute", "spherical", "fixed", "cylindrical", "revolute"}, 1},
    {"RRSU", 4, {"revolute", "revolute", "spherical", "universal"}, 1},
    {"RSSR", 4, {"revolute", "spherical", "spherical", "revolute"}, 2}, // the coupler spins
};

int ring_count(void) {
    return (int)(sizeof RINGS / sizeof *RINGS);
}

const ring *ring_at(int i) {
    return &RINGS[i];
}

static void add(char *text, const char *more) {
    assert_true(strlen(text) + strlen(more) < RING_TEXT);
    strcat(text, more);
}

/// Joint j between body j - 1 and body j (the ground at both ends), at corners of a skew polygon
/// with skew axes.
static void add_joint(char *text, const ring *r, int j, int cut) {
    static const double at[RING_MAX][3] = {{0, 0, 0},     {0.3, 0.8, 0.2},   {1.7, 1.1, 0.6},
                                           {2.1, 0.2, 0}, {1.1, -0.4, -0.3}, {0.2, 0.2, 0.2}};
    static const double axis[RING_MAX][3] = {{0.1, 0.2, 1},  {0.9, -0.2, 0.4}, {0.2, 1, 0.3},
                                             {-0.3, 0.4, 1}, {1, 0.2, -0.5},   {0, 1, 1}};
    char more[600], parent[32] = "ground", child[32] = "ground";
    if (j > 0) {
        snprintf(parent, sizeof parent, "b%d", j - 1);
    }
    if (j < r->n - 1) {
        snprintf(child, sizeof child, "b%d", j);
    }
    const double *p = at[j], *z = axis[j];
    char second[120] = "";
    if (strcmp(r->types[j], "universal") == 0) {
        snprintf(second, sizeof second, ",\"axis2\":[%.17g,%.17g,0]", z[1], -z[0]);
    }
    snprintf(more, sizeof more,
             "%s{\"name\":\"J%d\",\"type\":\"%s\",\"axis\":[%.17g,%.17g,%.17g]%s,"
             "\"parent\":{\"body\":\"%s\",\"at\":[%.17g,%.17g,%.17g]},"
             "\"child\":{\"body\":\"%s\",\"at\":[%.17g,%.17g,%.17g]}%s}",
             j ? "," : "", j, r->types[j], z[0], z[1], z[2], second, parent, p[0], p[1], p[2],
             child, p[0], p[1], p[2], cut > 0 && j == cut ? ",\"cut\":true" : "");
    add(text, more);
}

void ring_write(char text[RING_TEXT], const ring *r, int cut) {
    strcpy(text, "{\"holonom\":1,\"name\":\"ring\",\"gravity\":[1,-9,3],\"bodies\":[");
    for (int b = 0; b < r->n - 1; b++) {
        char more[300];
        snprintf(more, sizeof more,
                 "%s{\"name\":\"b%d\",\"mass\":%g,\"com\":[%g,0.3,%g],\"inertia\":{\"xx\":0.3,"
                 "\"yy\":0.4,\"zz\":0.5,\"xy\":0.03,\"yz\":-0.05}}",
                 b ? "," : "", b, 1 + 0.4 * b, 0.3 + 0.5 * b, 0.1 * b);
        add(text, more);
    }
    add(text, "],\"joints\":[");
    for (int j = 0; j < r->n; j++) {
        add_joint(text, r, j, cut);
    }
    add(text, "],\"start\":{\"positions\":{\"J0\":0},\"rates\":{\"J0\":1.3}}}");
}
