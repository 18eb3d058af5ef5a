// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/store/columns_json.h"

static const hn_coordinate *coordinate_of(const hn_system *sys, int user) {
    return &hn_system_scene(sys)->coordinates[hn_system_user_coordinate(sys, user)];
}

void hn_columns_put_coordinates(hn_strbuf *b, const hn_system *sys) {
    hn_json_key(b, "coordinates");
    hn_json_array(b);
    for (int i = 0; i < hn_system_get_info(sys).n_user; i++) {
        hn_json_string(b, coordinate_of(sys, i)->name);
    }
    hn_json_end_array(b);
}

void hn_columns_put_rates(hn_strbuf *b, const hn_system *sys) {
    hn_json_key(b, "rates");
    hn_json_array(b);
    for (int i = 0; i < hn_system_get_info(sys).n_user; i++) {
        hn_json_string(b, coordinate_of(sys, i)->rate);
    }
    hn_json_end_array(b);
}

void hn_columns_put_rows(hn_strbuf *b, const hn_system *sys) {
    hn_json_key(b, "rows");
    hn_json_array(b);
    for (int i = 0; i < hn_system_get_info(sys).nc; i++) {
        hn_json_string(b, hn_system_row_name(sys, i));
    }
    hn_json_end_array(b);
}

void hn_columns_put_table(hn_strbuf *b, const char *key, const double *values, long long n,
                          int width) {
    hn_json_key(b, key);
    hn_json_array(b);
    for (long long k = 0; k < n; k++) {
        hn_json_numbers(b, values + k * width, (size_t)width);
    }
    hn_json_end_array(b);
}
