// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/view.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const double DEGREE = 3.14159265358979324 / 180;

hn_view hn_view_look(double azimuth, double elevation) {
    const double ca = cos(azimuth), sa = sin(azimuth), ce = cos(elevation), se = sin(elevation);
    return (hn_view){
        .right = {ca, 0, -sa}, .up = {-se * sa, ce, -se * ca}, .toward = {ce * sa, se, ce * ca}};
}

hn_view hn_view_front(void) {
    return hn_view_look(0, 0);
}

hn_view hn_view_space(void) {
    return hn_view_look(35 * DEGREE, 22 * DEGREE);
}

static void stand_up(double v[3]) {
    const double y = v[1];
    v[1] = -v[2];
    v[2] = y;
}

hn_view hn_view_z_up(hn_view view) {
    stand_up(view.right);
    stand_up(view.up);
    stand_up(view.toward);
    return view;
}

void hn_view_project(const hn_view *view, const double world[3], double out[2]) {
    out[0] = out[1] = 0;
    for (int i = 0; i < 3; i++) {
        out[0] += view->right[i] * world[i];
        out[1] += view->up[i] * world[i];
    }
}

static bool parse_angles(const char *text, double angles[2]) {
    char *end;
    angles[0] = strtod(text, &end);
    if (end == text || *end != ',') {
        return false;
    }
    const char *second = end + 1;
    angles[1] = strtod(second, &end);
    return end != second && *end == '\0' && fabs(angles[0]) <= 360 && fabs(angles[1]) <= 90;
}

hn_status hn_view_parse(const char *text, hn_view *out, hn_diag *diag) {
    static const struct {
        const char *name;
        double azimuth, elevation; ///< [degrees]
    } named[] = {{"front", 0, 0}, {"side", 90, 0}, {"top", 0, 90}};

    // views with a name
    for (size_t i = 0; i < sizeof named / sizeof *named; i++) {
        if (strcmp(text, named[i].name) == 0) {
            *out = hn_view_look(named[i].azimuth * DEGREE, named[i].elevation * DEGREE);
            return HN_OK;
        }
    }
    double angles[2];
    if (strcmp(text, "space") == 0) {
        *out = hn_view_space();
        return HN_OK;
    }

    // azimuth and elevation
    if (parse_angles(text, angles)) {
        *out = hn_view_look(angles[0] * DEGREE, angles[1] * DEGREE);
        return HN_OK;
    }
    return hn_diag_set(diag, HN_ERR_INPUT, NULL,
                       "front, side, top, space, or azimuth and elevation in degrees as in 35,22",
                       "'%.40s' is not a view", text);
}
