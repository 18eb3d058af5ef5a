// SPDX-License-Identifier: GPL-3.0-or-later
// Kept studies: taken up where they were cut, never trusted halfway.
#include "support/near.h"

#include "session/precision/study.h"
#include "session/precision/wanted.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const METHODS[] = {"projection@rk4", "projection@dopri5"};

typedef struct place {
    hn_library *lib;
    hn_model *model;
    char folder[64];
} place;

static void open_place(place *p, const char *scene) {
    hn_diag diag = {0};
    hn_diags diags = {0};
    const hn_model_source source = {.name = scene};
    assert_int_equal(hn_library_open(".", &p->lib, &diag), HN_OK);
    assert_int_equal(hn_model_load(p->lib, &source, &p->model, &diags), HN_OK);
    strcpy(p->folder, "/tmp/hn-study-XXXXXX");
    assert_non_null(mkdtemp(p->folder));
}

/// Path of the first file that begins like this, "" when there is none.
static void find_file(const place *p, const char *begin, char out[400]) {
    DIR *dir = opendir(p->folder);
    out[0] = 0;
    for (struct dirent *e; (e = readdir(dir)) != NULL;) {
        if (strncmp(e->d_name, begin, strlen(begin)) == 0) {
            snprintf(out, 400, "%s/%s", p->folder, e->d_name);
        }
    }
    closedir(dir);
}

static void close_place(place *p) {
    char path[400];
    for (find_file(p, "re", path); path[0]; find_file(p, "re", path)) {
        assert_int_equal(remove(path), 0);
    }
    for (find_file(p, "st", path); path[0]; find_file(p, "st", path)) {
        assert_int_equal(remove(path), 0);
    }
    assert_int_equal(rmdir(p->folder), 0);
    hn_model_free(p->model);
    hn_library_free(p->lib);
}

static int points_done(const hn_study *study) {
    const hn_wp *wp = hn_study_wp(study);
    int n = 0;
    for (int m = 0; m < wp->n_methods; m++) {
        for (int k = 0; k < wp->n_levels; k++) {
            n += wp->methods[m].point[k].state == HN_WP_DONE;
        }
    }
    return n;
}

/// `user` is the study to cut, NULL before it is open.
static int stop_with_a_point(void *user) {
    const hn_study *const *study = user;
    return *study && points_done(*study) > 0;
}

static hn_job_request request_for(const hn_model *model) {
    hn_job_request r = hn_job_request_default(model);
    hn_diags diags = {0};
    assert_int_equal(hn_job_request_set_methods(&r, METHODS, 2, &diags), HN_OK);
    return r;
}

static hn_study *open_study(const place *p, hn_study **cut) {
    hn_study *study = NULL;
    hn_diags diags = {0};
    hn_job_request r = request_for(p->model);
    r.time = 0.5;
    hn_job_request_set(&r, "levels", 3);
    hn_job_request_set(&r, "samples", 0);
    r.limits.folder = p->folder;
    if (cut) {
        r.limits.user = cut;
        r.limits.stop = stop_with_a_point;
    }
    if (hn_study_open(&r, &study, &diags) != HN_OK) {
        fail_msg("%s", diags.item[0].message);
    }
    return study;
}

/// A study cut short; how many points it had.
static int cut_short(const place *p) {
    hn_study *cut = NULL; // the reference is not cut
    hn_study *study = open_study(p, &cut);
    cut = study;
    assert_false(hn_study_run(study));
    const int done = points_done(study);
    assert_true(done > 0 && done < 6);
    hn_study_free(study);
    return done;
}

static void a_study_goes_on_where_it_was_cut(void **state) {
    (void)state;
    place p;
    char path[400];
    open_place(&p, "fb0");
    const int done = cut_short(&p);
    hn_study *study = open_study(&p, NULL);
    assert_int_equal(hn_study_resumed(study), done);
    assert_true(hn_study_kept_reference(study));
    assert_true(hn_study_run(study));
    assert_int_equal(points_done(study), 6);
    hn_study_free(study);
    find_file(&p, "study", path);
    assert_string_equal(path, ""); // nothing is left of a finished one
    close_place(&p);
}

/// Returns what a study says of its times, with these in the first point.
static void assert_says(const hn_study *study, int times, bool too_long, const char *said) {
    hn_wp_point *p = &hn_study_wp(study)->methods[0].point[0];
    const hn_wp_point was = *p;
    hn_strbuf b;
    p->times = times;
    p->too_long = too_long;
    hn_strbuf_init(&b);
    hn_study_put_times(&b, study);
    assert_string_equal(hn_strbuf_text(&b), said);
    hn_strbuf_reset(&b);
    *p = was;
}

static void why_the_times_of_errors_are_few_is_told_as_it_is(void **state) {
    (void)state;
    place p;
    open_place(&p, "fb0");
    hn_study *study = open_study(&p, NULL);
    assert_true(hn_study_run(study));
    assert_says(study, 1024, false, "errors are the largest at 1024 times, evenly over the run");
    assert_says(study, 187, false,
                "errors are the largest at 187 times; in parts of the run at few times, as no "
                "method finds the true motion between these");
    assert_says(study, 187, true,
                "errors are the largest at 187 times; in parts of the run at few times, as the "
                "true motion between these takes too long to compute");
    hn_study_free(study);
    close_place(&p);
}

/// Gives the points of method m these errors and operations.
static void set_points(const hn_study *study, int m, const double error[3], const double ops[3]) {
    for (int k = 0; k < 3; k++) {
        hn_wp_point *p = &hn_study_wp(study)->methods[m].point[k];
        p->worst[HN_ERROR_Q] = error[k];
        p->cost.ops = ops[k];
    }
}

static void assert_cheapest(const hn_study *study, double error, const char *said) {
    hn_wanted wanted = {.error = error};
    char spelling[HN_SPEC_MAX];
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_wanted_text(&b, study, &wanted, spelling);
    if (!strstr(hn_strbuf_text(&b), said)) {
        fail_msg("%s", hn_strbuf_text(&b));
    }
    hn_strbuf_reset(&b);
}

static void the_next_method_costs_what_is_told_times_the_cost_that_is_told(void **state) {
    (void)state;
    place p;
    open_place(&p, "fb0");
    hn_study *study = open_study(&p, NULL);
    assert_true(hn_study_run(study));

    // a size for half the error, 1000 sqrt(20) operations by the line; 9000 / 4472
    set_points(study, 0, (double[]){1e-1, 1e-3, 1e-5}, (double[]){1000, 10000, 100000});
    set_points(study, 1, (double[]){5e-3, 1e-4, 1e-6}, (double[]){9000, 20000, 30000});
    assert_cheapest(study, 1e-2,
                    " is the cheapest, about 4472 operations. Next: projection@dopri5, 2.01 times "
                    "that.");
    // the line would go below the finer point, which was measured
    assert_cheapest(study, 1.5e-3, " is the cheapest, 10000 operations.");
    // no coarser size was tried
    assert_cheapest(study, 0.2, " is the cheapest, at most 1000 operations.");
    hn_study_free(study);
    close_place(&p);
}

static void a_torn_line_costs_one_point_and_no_more(void **state) {
    (void)state;
    place p;
    char path[400];
    open_place(&p, "fb0");
    const int done = cut_short(&p);
    find_file(&p, "study", path);
    FILE *f = fopen(path, "rb+");
    assert_int_equal(fseek(f, -7, SEEK_END), 0);
    assert_int_equal(ftruncate(fileno(f), ftell(f)), 0);
    fclose(f);
    hn_study *study = open_study(&p, NULL);
    assert_int_equal(hn_study_resumed(study), done - 1);
    assert_true(hn_study_run(study));
    assert_int_equal(points_done(study), 6);
    hn_study_free(study);
    close_place(&p);
}

static void lines_of_another_hand_are_not_taken(void **state) {
    (void)state;
    place p;
    char path[400];
    open_place(&p, "fb0");
    cut_short(&p);
    find_file(&p, "study", path);
    static const char *const lines[] = {
        "{}\n",
        "[1,2]\n",
        "{\"m\":0,\"k\":99}\n",
        "{\"m\":1e9,\"k\":0,\"cpu\":1}\n",
        "{\"m\":0,\"k\":2,\"state\":1,\"status\":0,\"reason\":\"\",\"numbers\":[1]}\n",
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        FILE *f = fopen(path, "wb");
        fputs(lines[i], f);
        fclose(f);
        hn_study *study = open_study(&p, NULL);
        assert_int_equal(hn_study_resumed(study), 0);
        assert_int_equal(points_done(study), 0);
        hn_study_free(study);
    }
    close_place(&p);
}

static void the_same_study_twice_at_once_is_refused(void **state) {
    (void)state;
    place p;
    hn_diags diags = {0};
    hn_study *second = NULL;
    open_place(&p, "fb0");
    hn_study *first = open_study(&p, NULL);
    hn_job_request r = request_for(p.model);
    r.time = 0.5;
    hn_job_request_set(&r, "levels", 3);
    r.limits.folder = p.folder;
    assert_int_equal(hn_study_open(&r, &second, &diags), HN_ERR_IO);
    assert_null(second);
    hn_study_free(first);
    close_place(&p);
}

/// A study of four free angles without a clock, to T: the bands of the coordinates' error, by
/// operations.
static hn_pareto bands_of(const char *scene, double T, double *horizon) {
    place p;
    hn_study *study = NULL;
    hn_diags diags = {0};
    hn_pareto pareto;
    open_place(&p, scene);
    hn_job_request r = request_for(p.model);
    r.time = T;
    hn_job_request_set(&r, "levels", 3);
    hn_job_request_set(&r, "samples", 0);
    r.limits.time_limit = 0;
    assert_int_equal(hn_study_open(&r, &study, &diags), HN_OK);
    assert_int_equal(hn_study_run(study), 1);
    hn_wp_pareto(hn_study_wp(study), hn_study_classes(study), HN_ERROR_Q, HN_COST_OPS, &pareto);
    *horizon = hn_study_wp(study)->horizon;
    if (pareto.beyond_horizon) { // energy still says something, and no method is called wrong
        hn_pareto energy;
        hn_wp_pareto(hn_study_wp(study), hn_study_classes(study), HN_ERROR_ENERGY, HN_COST_OPS,
                     &energy);
        assert_false(energy.beyond_horizon);
        assert_true(energy.n_bands > 0);
        assert_int_equal(hn_study_classes(study)[0].kind, HN_CLASS_UNSETTLED);
    }
    hn_study_free(study);
    close_place(&p);
    return pareto;
}

static void beyond_the_horizon_of_chaos_errors_are_not_ranked(void **state) {
    (void)state;
    double horizon;
    const hn_pareto late = bands_of("four-angles-as-printed", 30, &horizon);
    assert_true(late.beyond_horizon && late.n_bands == 0);
    assert_true(horizon > 10 && horizon < 30);
    // neighbours part by a factor e in a second: little in two
    const hn_pareto soon = bands_of("four-angles-as-printed", 2, &horizon);
    assert_true(!soon.beyond_horizon && soon.n_bands > 2);
    const hn_pareto one_freedom = bands_of("fb0", 10, &horizon);
    assert_true(!one_freedom.beyond_horizon && one_freedom.n_bands > 2 && horizon == 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_study_goes_on_where_it_was_cut),
        cmocka_unit_test(why_the_times_of_errors_are_few_is_told_as_it_is),
        cmocka_unit_test(the_next_method_costs_what_is_told_times_the_cost_that_is_told),
        cmocka_unit_test(a_torn_line_costs_one_point_and_no_more),
        cmocka_unit_test(lines_of_another_hand_are_not_taken),
        cmocka_unit_test(the_same_study_twice_at_once_is_refused),
        cmocka_unit_test(beyond_the_horizon_of_chaos_errors_are_not_ranked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
