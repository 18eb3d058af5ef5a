// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/model/equations.h"

#include "dynamics/compile/compile.h"
#include "dynamics/compile/coordinates.h"
#include "expr/angles.h"
#include "expr/print.h"
#include "session/model/model.h"
#include "session/model/position_form.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { LARGEST_TEXT = 8 << 20 };

/// One term of the equations: its symbol, its shape and its expressions.
typedef struct term {
    const char *name, *latex, *meaning;
    const hn_ex *e;
    int rows, cols; ///< cols 0: a vector
    int symmetric;  ///< only the lower triangle is written
} term;

enum { N_TERMS = 5 };

static hn_status list_terms(const hn_system *sys, hn_arena *arena, term out[N_TERMS]) {
    const hn_ex *M = hn_system_dense_mass(sys, arena), *J = hn_system_dense_jacobian(sys, arena);
    if (!M || !J) {
        return HN_ERR_MEMORY;
    }
    hn_system_exprs x = hn_system_get_exprs(sys);
    hn_system_info info = hn_system_get_info(sys);
    const term list[N_TERMS] = {
        {"M", "M", "mass matrix", M, info.nv, info.nv, 1},
        {"f", "f", "applied, gravity and velocity forces, Q - h", x.f, info.nv, 0, 0},
        {"phi", "\\varphi", "loop closure", x.phi, info.nc, 0, 0},
        {"J", "J", "closure Jacobian", J, info.nc, info.nv, 0},
        {"gamma", "\\gamma", "closure acceleration at a = 0", x.gamma, info.nc, 0, 0},
    };
    memcpy(out, list, sizeof list);

    // as they read best: cos a cos b + sin a sin b is cos(a - b)
    for (int k = 0; k < N_TERMS; k++) {
        const size_t n = (size_t)out[k].rows * (size_t)(out[k].cols ? out[k].cols : 1);
        hn_ex *joined = hn_arena_get(arena, n * sizeof *joined);
        if (!joined) {
            return HN_ERR_MEMORY;
        }
        memcpy(joined, out[k].e, n * sizeof *joined);
        HN_TRY(hn_angles_join(hn_system_graph(sys), joined, (int)n));
        out[k].e = joined;
    }
    return HN_OK;
}

static const char *symbol_name(const hn_system *sys, int symbol) {
    return hn_graph_symbol_name(hn_system_graph(sys), symbol);
}

/// Writes the quaternion to which velocity i, a component of a rotation vector, belongs.
static void put_orientation(hn_strbuf *b, const hn_system *sys, int i) {
    hn_system_exprs x = hn_system_get_exprs(sys);
    int at = 0, part = 0; // of q; of the orientation
    for (int j = 0; j < i; j++) {
        if (hn_system_position_of(sys, j) >= 0) {
            at++;
        } else {
            part = (part + 1) % 3;
            at += part == 0 ? 4 : 0;
        }
    }
    static const char axes[3] = {'x', 'y', 'z'};
    hn_strbuf_printf(b, "%c of the rotation vector of the unit quaternion (", axes[part]);
    for (int k = 0; k < 4; k++) {
        hn_strbuf_printf(b, "%s%s", k ? ", " : "", symbol_name(sys, x.q_symbols[at + k]));
    }
    hn_strbuf_add(b, ")");
}

/// "th2 = q2 - q1" for each scene coordinate that is not a system coordinate itself.
static void put_coordinate(hn_strbuf *b, const hn_system *sys, int i, double *unit, double *image) {
    hn_system_info info = hn_system_get_info(sys);
    hn_system_exprs x = hn_system_get_exprs(sys);
    int first = 1;
    if (hn_system_position_of(sys, i) < 0) {
        put_orientation(b, sys, i);
        return;
    }

    // other coordinates: a linear combination, one rate after the other
    for (int j = 0; j < info.nv; j++) {
        memset(unit, 0, (size_t)info.nv * sizeof *unit);
        unit[j] = 1;
        hn_system_rates_to_user(sys, unit, image);
        double c = image[i];
        if (c != 0) {
            const char *sign = c < 0 ? (first ? "-" : " - ") : (first ? "" : " + ");
            hn_strbuf_add(b, sign);
            if (fabs(c) != 1) {
                hn_strbuf_printf(b, "%.15g*", fabs(c));
            }
            hn_strbuf_add(b, symbol_name(sys, x.q_symbols[hn_system_position_of(sys, j)]));
            first = 0;
        }
    }
}

/// Returns 1 if the entry is written: not zero, and for a symmetric matrix not above the diagonal.
static bool is_told(const term *m, int i, int j) {
    return !(m->symmetric && j > i) && !hn_is_zero(m->cols ? m->e[i * m->cols + j] : m->e[i]);
}

typedef void (*entry_writer)(hn_strbuf *b, hn_graph *g, const term *m, int i, int j);

static void write_text(hn_strbuf *b, hn_graph *g, const term *m, int i, int j) {
    if (m->cols) {
        hn_strbuf_printf(b, "%s[%d][%d] = ", m->name, i + 1, j + 1);
    } else {
        hn_strbuf_printf(b, "%s[%d] = ", m->name, i + 1);
    }
    hn_print(b, g, m->cols ? m->e[i * m->cols + j] : m->e[i], HN_PRINT_TEXT, 0);
    hn_strbuf_add(b, "\n");
}

static void put_latex_name(hn_strbuf *b, const term *m, int i, int j) {
    if (m->cols) {
        hn_strbuf_printf(b, "%s_{%d%s%d}", m->latex, i + 1, m->cols > 9 || m->rows > 9 ? "," : "",
                         j + 1);
    } else {
        hn_strbuf_printf(b, "%s_{%d}", m->latex, i + 1);
    }
}

static void write_latex(hn_strbuf *b, hn_graph *g, const term *m, int i, int j) {
    hn_strbuf_add(b, "  ");
    put_latex_name(b, m, i, j);
    hn_strbuf_add(b, " &= ");
    hn_print(b, g, m->cols ? m->e[i * m->cols + j] : m->e[i], HN_PRINT_LATEX, 6);
    hn_strbuf_add(b, " \\\\\n");
}

static void write_json(hn_strbuf *b, hn_graph *g, const term *m, int i, int j) {
    hn_ex e = m->cols ? m->e[i * m->cols + j] : m->e[i];
    hn_strbuf piece;
    hn_strbuf_init(&piece);

    // place of the entry in its term
    hn_json_object(b);
    hn_json_put_string(b, "term", m->name);
    hn_json_put_int(b, "row", i + 1);
    if (m->cols) {
        hn_json_put_int(b, "column", j + 1);
    }

    // the expression as text and as LaTeX
    hn_print(&piece, g, e, HN_PRINT_TEXT, 0);
    hn_json_put_string(b, "text", hn_strbuf_text(&piece));
    hn_strbuf_clear(&piece);
    put_latex_name(&piece, m, i, j);
    hn_json_put_string(b, "name_latex", hn_strbuf_text(&piece));
    hn_strbuf_clear(&piece);
    hn_print(&piece, g, e, HN_PRINT_LATEX, 6);
    hn_json_put_string(b, "latex", hn_strbuf_text(&piece));
    hn_json_end_object(b);
    b->failed |= piece.failed;
    hn_strbuf_reset(&piece);
}

static void write_entries(hn_strbuf *b, hn_graph *g, const term *m, entry_writer write) {
    for (int i = 0; i < m->rows; i++) {
        for (int j = 0; j < (m->cols ? m->cols : 1); j++) {
            if (is_told(m, i, j) && b->n < LARGEST_TEXT) {
                write(b, g, m, i, j);
            }
        }
    }
}

static int count_entries(const term *m) {
    int n = 0;
    for (int i = 0; i < m->rows; i++) {
        for (int j = 0; j < (m->cols ? m->cols : 1); j++) {
            n += is_told(m, i, j);
        }
    }
    return n;
}

static const char *const SYSTEM_TEXT = "M a = f + J' lambda\nJ a + gamma = 0\nphi = 0\n";
static const char *const OTHER_COORDINATES =
    "\ncoordinates of the scene by those of the equations (the same where not listed):\n";
static const char *const SYSTEM_LATEX =
    "\\[ M\\,a = f + J^{\\mathsf T}\\lambda, \\qquad J\\,a + \\gamma = 0, \\qquad "
    "\\varphi = 0 \\]\n";

/// A line for each coordinate of the scene that the system does not have itself, below a title.
static void put_other_coordinates(hn_strbuf *b, const hn_system *sys, double *unit, double *image) {
    const hn_scene *scene = hn_system_scene(sys);
    bool titled = false;
    for (int i = 0; i < hn_system_get_info(sys).n_user; i++) {
        const char *name = scene->coordinates[hn_system_user_coordinate(sys, i)].name;
        hn_strbuf is;
        hn_strbuf_init(&is);
        put_coordinate(&is, sys, i, unit, image);
        if (strcmp(hn_strbuf_text(&is), name) != 0) {
            hn_strbuf_printf(b, "%s%s = %s\n", titled ? "" : OTHER_COORDINATES, name,
                             hn_strbuf_text(&is));
            titled = true;
        }
        b->failed |= is.failed;
        hn_strbuf_reset(&is);
    }
}

static void put_text(hn_strbuf *b, const hn_system *sys, const term *terms, double *unit,
                     double *image, const hn_position_form *position) {
    const hn_scene *scene = hn_system_scene(sys);
    hn_system_exprs x = hn_system_get_exprs(sys);
    hn_system_info info = hn_system_get_info(sys);

    // title, and the system that the terms belong to
    hn_strbuf_printf(b, "%s\n%s\n", scene->title ? scene->title : scene->id, SYSTEM_TEXT);
    hn_strbuf_add(b, "velocities, in the order of rows and columns:");
    for (int i = 0; i < info.nv; i++) {
        hn_strbuf_printf(b, "%s %s", i ? "," : "", symbol_name(sys, x.v_symbols[i]));
    }
    hn_strbuf_add(b, "\n");

    put_other_coordinates(b, sys, unit, image);

    // entries of every term, then the position form
    for (int k = 0; k < N_TERMS; k++) {
        hn_strbuf_printf(b, "\n%s (%s; %s)\n", terms[k].name, terms[k].meaning,
                         terms[k].symmetric ? "symmetric: of M[i,j] = M[j,i] one is listed; "
                                              "entries that are not listed are zero"
                                            : "entries not listed are zero");
        write_entries(b, hn_system_graph(sys), &terms[k], write_text);
    }
    hn_position_form_text(b, position);
}

static void put_latex(hn_strbuf *b, const hn_system *sys, const term *terms,
                      const hn_position_form *position) {
    hn_strbuf_printf(b, "%% %s\n%s",
                     hn_system_scene(sys)->title ? hn_system_scene(sys)->title
                                                 : hn_system_scene(sys)->id,
                     SYSTEM_LATEX);
    for (int k = 0; k < N_TERMS; k++) {
        if (count_entries(&terms[k]) > 0) {
            hn_strbuf_printf(b, "%% %s\n\\begin{align*}\n", terms[k].meaning);
            write_entries(b, hn_system_graph(sys), &terms[k], write_latex);
            hn_strbuf_add(b, "\\end{align*}\n");
        }
    }
    hn_position_form_latex(b, position);
}

static void put_json(hn_strbuf *b, const hn_system *sys, const term *terms, double *unit,
                     double *image, const hn_position_form *position) {
    const hn_scene *scene = hn_system_scene(sys);
    hn_system_exprs x = hn_system_get_exprs(sys);
    hn_system_info info = hn_system_get_info(sys);
    hn_json_object(b);
    hn_json_put_string(b, "scene", scene->id);
    hn_json_put_string(b, "equations", SYSTEM_TEXT);
    hn_json_key(b, "speeds");
    hn_json_array(b);
    for (int i = 0; i < info.nv; i++) {
        hn_json_string(b, symbol_name(sys, x.v_symbols[i]));
    }
    hn_json_end_array(b);

    // coordinates of the scene in those of the system
    hn_json_key(b, "coordinates");
    hn_json_array(b);
    for (int i = 0; i < info.n_user; i++) {
        hn_strbuf text;
        hn_strbuf_init(&text);
        put_coordinate(&text, sys, i, unit, image);
        hn_json_object(b);
        hn_json_put_string(b, "name", scene->coordinates[hn_system_user_coordinate(sys, i)].name);
        hn_json_put_string(b, "is", hn_strbuf_text(&text));
        hn_json_end_object(b);
        b->failed |= text.failed;
        hn_strbuf_reset(&text);
    }
    hn_json_end_array(b);

    // sizes of the terms, then their entries
    hn_json_key(b, "terms");
    hn_json_array(b);
    for (int k = 0; k < N_TERMS; k++) {
        hn_json_object(b);
        hn_json_put_string(b, "name", terms[k].name);
        hn_json_put_string(b, "latex", terms[k].latex);
        hn_json_put_string(b, "meaning", terms[k].meaning);
        hn_json_put_int(b, "rows", terms[k].rows);
        hn_json_put_int(b, "columns", terms[k].cols ? terms[k].cols : 1);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
    hn_json_key(b, "entries");
    hn_json_array(b);
    for (int k = 0; k < N_TERMS; k++) {
        write_entries(b, hn_system_graph(sys), &terms[k], write_json);
    }
    hn_json_end_array(b);
    hn_position_form_json(b, position);
    hn_json_end_object(b);
}

hn_status hn_model_equations(hn_strbuf *b, const hn_model *model, hn_equation_form form,
                             hn_diags *diags) {
    hn_system *sys = NULL;

    // compile with the parameters as symbols
    hn_system_opts opts = hn_system_opts_default();
    opts.symbolic_params = 1;
    hn_status status = hn_system_compile(hn_model_scene(model), &opts, &sys, diags);
    if (status != HN_OK) {
        return status;
    }

    // position form and workspace
    hn_system_info info = hn_system_get_info(sys);
    hn_position_form position;
    status = hn_position_form_create(model, sys, &position);
    double *unit = position.arena ? hn_arena_doubles(position.arena, (size_t)info.nv + 1) : NULL;
    double *image =
        position.arena ? hn_arena_doubles(position.arena, (size_t)info.n_user + 1) : NULL;
    term terms[N_TERMS];
    if (status == HN_OK) {
        status = unit && image ? list_terms(sys, position.arena, terms) : HN_ERR_MEMORY;
    }

    // write in the form asked for
    if (status == HN_OK && form == HN_EQUATIONS_TEXT) {
        put_text(b, sys, terms, unit, image, &position);
    } else if (status == HN_OK && form == HN_EQUATIONS_LATEX) {
        put_latex(b, sys, terms, &position);
    } else if (status == HN_OK) {
        put_json(b, sys, terms, unit, image, &position);
    }

    // a truncated text is an error
    if (status == HN_OK && b->n >= LARGEST_TEXT) {
        status = hn_diags_add(diags, HN_ERR_LIMIT, "/scene", "take a smaller scene",
                              "the equations are longer than %d bytes", LARGEST_TEXT);
    }
    hn_position_form_free(&position);
    hn_system_free(sys);
    return status == HN_OK && b->failed ? HN_ERR_MEMORY : status;
}
