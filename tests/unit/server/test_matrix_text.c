// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas of matrices: read in any notation, and refused where they do not fit or may be misread.
#include "grade/parts/matrix_text.h"

#include "support/near.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct two {
    hn_matrix A, v, alpha;
} two;

static const hn_matrix *find(void *user, const char *name) {
    two *t = user;
    return strcmp(name, "A") == 0       ? &t->A
           : strcmp(name, "vdot") == 0  ? &t->v
           : strcmp(name, "alpha") == 0 ? &t->alpha
                                        : NULL;
}

/// The first entry of a formula with A = [1 2; 3 4], vdot = (5; 6) and the number alpha = 7.
static hn_status eval(const char *text, double *x, hn_diag *diag) {
    two t = {
        {2, 2, 0, (double[]){1, 2, 3, 4}}, {2, 1, 0, (double[]){5, 6}}, {1, 1, 1, (double[]){7}}};
    static const char *const known[] = {"A", "vdot"};
    const hn_matrix_names names = {find, &t, known, 2};
    hn_arena *arena = hn_arena_create(0);
    hn_matrix out = {0};
    const hn_status status = hn_matrix_eval(text, &names, arena, &out, diag);
    *x = status == HN_OK ? out.x[0] : (double)NAN;
    hn_arena_free(arena);
    return status;
}

static void matrices_are_read_in_any_notation(void **state) {
    (void)state;
    static const struct {
        const char *text;
        double first;
    } rows[] = {
        {"A", 1},
        {"A'*vdot", 23},
        {"A^T vdot", 23},
        {"A.T @ vdot", 23},
        {"A^{\\top} \\dot{v}", 23},
        {"\\mathbf{A}^\\top \\dot v", 23},
        {"transpose(A) v_dot", 23},
        {"Aᵀ·v̇", 23},
        {"-A vdot", -17},
        {"2 A vdot - vdot", 29},
        {"A*inv(A)", 1},
        {"A^-1 A", 1},
        {"(A + A')'", 2},
        {"0 - A", -1},
        {"A*dv", 17},
        // marks of the transpose in LaTeX
        {"A^{\\mathsf T} vdot", 23},
        {"A^{\\mathsf{T}} vdot", 23},
        {"A^\\mathsf{T} vdot", 23},
        {"A^{\\mathrm T} vdot", 23},
        {"A^{\\mathrm{T}} vdot", 23},
        {"A^{\\intercal} vdot", 23},
        {"A^\\intercal vdot", 23},
        {"A^{\\prime} vdot", 23},
        {"A^{\\top} vdot", 23},
        {"A^{ T } vdot", 23},
        // dots: a product, entry by entry, or of a number
        {"A.vdot", 17},
        {"A . vdot", 17},
        {"A.A", 7},
        {"A.'*vdot", 23},
        {"A.T.vdot", 23},
        {"2.*A*vdot", 34},
        {"A.*2.*3", 6},
        {".5 A", 0.5},
        {"2.^2.*A", 4},
        {"3.^2.*A", 9},
        {"vdot.^2", 25},
        {"vdot.*vdot", 25},
        {"A./2", 0.5},
        {"A/4", 0.25},
        // division from the left: inv(A) vdot = (-4; 4.5)
        {"A \\ vdot", -4},
        {"A\\vdot", -4},
        {"A\\(vdot)", -4},
        {"-A\\vdot + vdot", 9},
        {"A'\\inv(A)*A", -2},
        {"2*A\\vdot", -2},
        {"A\\ \\dot{v}", 17},
        // functions of programs
        {"np.linalg.inv(A)*vdot", -4},
        {"Inverse[A].vdot", -4},
        {"Transpose[A].vdot", 23},
        // letters
        {"2α A", 14},
        {"2\\alpha A", 14},
        {"2 A \\alpha", 14},
        {"A^{T}\\alpha", 7},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double x = 0;
        hn_diag diag = {0};
        if (eval(rows[i].text, &x, &diag) != HN_OK) {
            fail_msg("%s: %s", rows[i].text, diag.message);
        }
        assert_near(x, rows[i].first, 1e-12);
    }
}

static void matrices_that_do_not_fit_are_refused(void **state) {
    (void)state;
    static const struct {
        const char *text;
        hn_status status;
    } rows[] = {
        {"vdot*A", HN_ERR_UNSUPPORTED},
        {"A + vdot", HN_ERR_UNSUPPORTED},
        {"inv(vdot)", HN_ERR_UNSUPPORTED},
        {"inv(A-A)", HN_ERR_SINGULAR},
        {"B", HN_ERR_INPUT},
        {"A *", HN_ERR_INPUT},
        {"(A", HN_ERR_INPUT},
        {"A)", HN_ERR_INPUT},
        {"", HN_ERR_INPUT},
        {"A^", HN_ERR_INPUT},
        {"\\dot", HN_ERR_INPUT},
        {"{", HN_ERR_INPUT},
        {"A;A", HN_ERR_INPUT},
        {"\\", HN_ERR_INPUT},
        {"A.*vdot", HN_ERR_UNSUPPORTED},
        {"A/0", HN_ERR_SINGULAR},
        {"2/A", HN_ERR_INPUT},
        {".", HN_ERR_INPUT},
        {"vdot_{a", HN_ERR_INPUT},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double x;
        hn_diag diag = {0};
        assert_int_equal(eval(rows[i].text, &x, &diag), rows[i].status);
        assert_true(diag.message[0] != 0);
    }
    char deep[600];
    double x;
    memset(deep, '(', 500);
    deep[500] = 0;
    assert_int_equal(eval(deep, &x, NULL), HN_ERR_INPUT);
}

static void what_may_be_misread_is_refused_at_its_column(void **state) {
    (void)state;
    static const struct {
        const char *text, *column;
    } rows[] = {
        {"A\\alpha", "column 2:"},          // LaTeX: A alpha; MATLAB: inv(A) alpha
        {"A\\ vdot", "column 2:"},          // the same
        {"A^{T} \\ vdot", "column 7:"},     //
        {"A \\\\ vdot", "column 3:"},       // two backslashes
        {"A \\foo vdot", "column 3:"},      // commands that are none
        {"\\hat{A}", "column 1:"},          //
        {"A \\cdots vdot", "column 3:"},    // more than \cdot
        {"A^{\\dagger}", "column 2:"},      // powers that are not known
        {"A vdot^{\\dagger}", "column 7:"}, // before the shapes are looked at
        {"A^25", "column 2:"},              //
        {"A^2.5", "column 2:"},             //
        {"A^-12", "column 2:"},             //
        {"A^*vdot", "column 2:"},           //
        {"A^{\\mathsf{T} vdot", "column 2:"},
        {"1.2.3 A", "column 4:"},
        {"A % vdot", "column 3:"}, // characters that are none
        {"A ∘ vdot", "column 3:"}, //
        {"A ⊗ A", "column 3:"},    //
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double x;
        hn_diag diag = {0};
        assert_int_equal(eval(rows[i].text, &x, &diag), HN_ERR_INPUT);
        if (!strstr(diag.message, rows[i].column)) {
            fail_msg("%s: '%s', wanted %s", rows[i].text, diag.message, rows[i].column);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matrices_are_read_in_any_notation),
        cmocka_unit_test(matrices_that_do_not_fit_are_refused),
        cmocka_unit_test(what_may_be_misread_is_refused_at_its_column),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
