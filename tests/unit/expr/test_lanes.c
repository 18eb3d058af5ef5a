// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // sincos
#include "support/near.h"

#include "base/arena.h"
#include "expr/construct.h"
#include "expr/lanes_tape.h"
#include "expr/native.h"
#include "expr/parse.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { N_IN = 3, N_OUT = 12, BLOCKS = 40 };

static bool same_bits(double a, double b) {
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

static double next(uint64_t *x) {
    *x = *x * 6364136223846793005ull + 1442695040888963407ull;
    return (double)(*x >> 11) * 0x1p-52 - 1;
}

static int look_up(void *user, const char *name, hn_ex *out) {
    const int symbol = hn_graph_find_symbol(user, name);
    *out = symbol >= 0 ? hn_graph_symbol_expr(user, symbol) : hn_num(0);
    return symbol >= 0;
}

/// Sums and products of every shape, and every function of the operator table.
static hn_tape *make_tape(void) {
    static const char *const formulas[N_OUT] = {
        "x*y + y*z - x*z",
        "x*y*z*x - (y + z)*x - y*y",
        "(x - y)/(z + 3) + x/y - z",
        "sin(x) + cos(x)*sin(y)",
        "cos(z)*2.5 - y*x*3 - z",
        "sqrt(x*x + y*y) - sqrt(x)",
        "tan(x) + atan2(y, z) + asin(x/4)*acos(y/4)",
        "sinh(x)*cosh(y) - tanh(z) + exp(x)*log(y)",
        "abs(x) + sign(y)*step(z) - min(x, y)*max(y, z)",
        "x^y + x^3 - z^(-2)",
        "-x - y - z",
        "atan(x*y) + sin(x + y)*cos(x + y) + 7*x - 0.1*y*y*y",
    };
    hn_graph *g = hn_graph_create();
    hn_ex out[N_OUT];
    int symbols[N_IN];
    hn_tape *tape = NULL;
    const hn_parse_opts opts = {.lookup = look_up, .user = g};
    hn_diag diag = {0};

    for (int i = 0; i < N_IN; i++) {
        symbols[i] = hn_ex_symbol(g, hn_symbol(g, (const char *[]){"x", "y", "z"}[i], NULL));
    }
    for (int i = 0; i < N_OUT; i++) {
        assert_int_equal(hn_parse(g, formulas[i], &opts, &out[i], &diag), HN_OK);
    }
    assert_int_equal(hn_tape_compile(g, out, N_OUT, symbols, N_IN, &tape), HN_OK);
    hn_graph_free(g);
    return tape;
}

/// Hundreds of instructions with values, sines among them, that are needed far behind.
static hn_tape *make_long_tape(void) {
    hn_graph *g = hn_graph_create();
    hn_ex in[N_IN], out[N_OUT];
    int symbols[N_IN];
    hn_tape *tape = NULL;
    for (int i = 0; i < N_IN; i++) {
        in[i] = hn_symbol(g, (const char *[]){"x", "y", "z"}[i], NULL);
        symbols[i] = hn_ex_symbol(g, in[i]);
    }
    hn_ex x = in[0], y = in[1], z = in[2];
    const hn_ex early = hn_sin(g, hn_mul(g, x, y)), beside = hn_cos(g, hn_mul(g, x, y));
    for (int i = 0; i < 60; i++) {
        const hn_ex angle = hn_add(g, x, hn_scale(0.3, y));
        const hn_ex s =
            i % 3 == 0 ? hn_sin(g, angle) : hn_mul(g, hn_sin(g, angle), hn_cos(g, angle));
        y = hn_add(g, hn_mul(g, z, s), hn_scale(0.5, y));
        z = hn_sub(g, hn_mul(g, s, hn_num(0.25 + i)), hn_scale(0.9, z));
        x = hn_add(g, s, hn_scale(1e-3, i % 2 ? early : beside));
        out[i % N_OUT] = hn_sum(g, (hn_ex[]){x, y, z}, 3);
    }
    assert_int_equal(hn_tape_compile(g, out, N_OUT, symbols, N_IN, &tape), HN_OK);
    hn_graph_free(g);
    return tape;
}

/// Inputs of one lane: ordinary numbers, large ones, and what functions treat apart.
static void fill_lane(int lane, int block, uint64_t *x, double in[N_IN]) {
    static const double odd[] = {0, -0.0, HUGE_VAL, -HUGE_VAL, (double)NAN, 1e300, -5e-324, 1e9};
    for (int i = 0; i < N_IN; i++) {
        in[i] = next(x) * (block % 2 ? 4 : 100);
        if ((lane + i + block) % 7 == 0) {
            in[i] = odd[(lane + block) % 8];
        }
    }
}

/// Compares a block with the interpreter, lane by lane; returns what differs.
static int count_differences(const hn_tape *tape, const double *work, double in[][N_IN],
                             double *scalar) {
    int differences = 0;
    for (int k = 0; k < HN_LANES; k++) {
        double out[N_OUT];
        hn_tape_eval(tape, in[k], out, scalar);
        for (int j = 0; j < N_OUT; j++) {
            const double got = work[HN_LANES * hn_tape_output_slots(tape)[j] + k];
            differences += !same_bits(got, out[j]);
        }
    }
    return differences;
}

/// Blocks of random states by this set: each lane as the interpreter evaluates it.
static void check_blocks(const hn_tape *tape, const hn_lanes_tape *lanes) {
    hn_arena *arena = hn_arena_create(0);
    double *scalar = hn_arena_doubles(arena, hn_tape_work_size(tape)),
           *work = hn_arena_doubles(arena, hn_lanes_work_size(tape)), in[HN_LANES][N_IN];
    uint64_t x = 17;
    hn_tape_prepare(tape, scalar);
    hn_lanes_prepare(tape, work);
    for (int block = 0; block < BLOCKS; block++) {
        for (int k = 0; k < HN_LANES; k++) {
            fill_lane(k, block, &x, in[k]);
            for (int i = 0; i < N_IN; i++) {
                work[HN_LANES * i + k] = in[k][i];
            }
        }
        hn_lanes_tape_run(lanes, work);
        assert_int_equal(count_differences(tape, work, in, scalar), 0);
    }
    hn_arena_free(arena);
}

static void each_lane_has_the_bits_of_the_interpreter(void **state) {
    (void)state;
    hn_tape *tapes[] = {make_tape(), make_long_tape()};
    for (int set = 0; set <= (int)hn_lanes_set_best(); set++) {
        for (int i = 0; i < 2; i++) {
            hn_lanes_tape lanes;
            hn_lanes_tape_init(&lanes, tapes[i], (hn_lanes_set)set);
            assert_null(lanes.native); // the service is off
            check_blocks(tapes[i], &lanes);
            hn_lanes_tape_reset(&lanes);
        }
    }
    hn_tape_free(tapes[0]);
    hn_tape_free(tapes[1]);
}

/// Removes a folder and the files in it.
static void remove_folder(const char *folder) {
    char path[400];
    DIR *d = opendir(folder);
    for (struct dirent *e; (e = readdir(d)) != NULL;) {
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        unlink(path);
    }
    closedir(d);
    assert_int_equal(rmdir(folder), 0);
}

static void compiled_lanes_have_the_bits_of_the_interpreter(void **state) {
    (void)state;
    char folder[] = "/tmp/holonom-lanes-XXXXXX", why[HN_DIAG_MESSAGE];
    hn_tape *tapes[] = {make_tape(), make_long_tape()}; // single states stay interpreted
    hn_native_opts opts = hn_native_opts_default(mkdtemp(folder));
    opts.look_after = opts.build_after = 0;
    opts.time_limit = 600; // a compiler may have to wait for a busy machine
    hn_native_start(&opts);
    for (int set = 0; set <= (int)hn_lanes_set_best(); set++) {
        for (int i = 0; i < 2; i++) {
            hn_lanes_tape lanes, again;
            hn_lanes_tape_init(&lanes, tapes[i], (hn_lanes_set)set);
            assert_non_null(lanes.native);
            check_blocks(tapes[i], &lanes); // asks for the code
            hn_native_wait();
            hn_native_reason(why);
            assert_string_equal(why, "");
            assert_non_null(atomic_load(&lanes.native->code));
            check_blocks(tapes[i], &lanes);

            // the next user of the tape has the code at once, and of this set
            hn_lanes_tape_init(&again, tapes[i], (hn_lanes_set)set);
            assert_true(atomic_load(&again.native->code) == atomic_load(&lanes.native->code));
            hn_lanes_tape_reset(&again);
            hn_lanes_tape_reset(&lanes);
        }
    }
    assert_int_equal(hn_native_get_counts().ready, 2 * (1 + (int)hn_lanes_set_best()));
    hn_native_stop();
    remove_folder(folder);
    hn_tape_free(tapes[0]);
    hn_tape_free(tapes[1]);
}

/// Angles where a form changes its way, their neighbours, and every multiple of pi/4.
static double angle_of_interest(int i, uint64_t *x) {
    static const double edges[] = {0.126, 0x1.b6p-1, 0x1.368fdp1, 0x1.921fbp26, 0x1p-27, 0};
    switch (i % 5) {
    case 0:
        return copysign(edges[i / 5 % 6], next(x));
    case 1:
        return copysign(nextafter(edges[i / 5 % 6], 0), next(x));
    case 2:
        return rint(next(x) * 1e4) * 0.78539816339744830962;
    case 3:
        return rint(next(x) * 640) / 128 + 1 / 256.0;
    default:
        return next(x) * pow(10, next(x) * 9);
    }
}

static void sines_of_lanes_have_the_bits_of_the_c_library(void **state) {
    (void)state;
    enum { N = 1024, TIMES = 200 };
    static _Alignas(64) double angle[N], sine[N], cosine[N];
    for (int set = 0; set <= (int)hn_lanes_set_best(); set++) {
        uint64_t x = 5;
        long differences = 0;
        const hn_lanes_sincos form = hn_lanes_sincos_get((hn_lanes_set)set);
        for (int time = 0; time < TIMES; time++) {
            for (int i = 0; i < N; i++) {
                angle[i] = angle_of_interest(i, &x);
            }
            form(N, angle, sine, cosine);
            for (int i = 0; i < N; i++) {
                double s, c;
                sincos(angle[i], &s, &c);
                differences += !same_bits(sine[i], s) + !same_bits(cosine[i], c);
            }
        }
        assert_int_equal(differences, 0);
    }
}

/// A form that is refused costs a factor of four in time and nothing else, so it has to be said
/// where the library is the one that the forms are written for.
static void vector_sines_serve_with_the_gnu_library(void **state) {
    (void)state;
#if __GLIBC__ == 2 && __GLIBC_MINOR__ == 36
    for (int set = HN_LANES_AVX2; set <= (int)hn_lanes_set_best(); set++) {
        assert_true(hn_lanes_sincos_is_vector((hn_lanes_set)set));
    }
#endif
    assert_false(hn_lanes_sincos_is_vector(HN_LANES_PLAIN));
}

/// Beside the C library, bit for bit; a NaN may be another one.
static void assert_four(hn_lanes_sincos_four four, const double x[4]) {
    double sine[4], cosine[4];
    four(x[0], x[1], x[2], x[3], sine, cosine);
    for (int i = 0; i < 4; i++) {
        const double wanted[2] = {sin(x[i]), cos(x[i])};
        if (isnan(wanted[0])) {
            assert_true(isnan(sine[i]) && isnan(cosine[i]));
        } else {
            assert_memory_equal(&sine[i], &wanted[0], sizeof *sine);
            assert_memory_equal(&cosine[i], &wanted[1], sizeof *cosine);
        }
    }
}

// the angles of the last call are remembered: what comes back must be theirs, however they recur
static void four_angles_are_those_of_the_library_however_they_recur(void **state) {
    (void)state;
    const hn_lanes_sincos_four four = hn_lanes_sincos_four_get();
    if (!four) {
        skip();
    }
    static const double sets[][4] = {
        {0, 0, 0, 0},      {-0.0, 0, 0, -0.0},     {1, 0.5, 1.5, 1},   {0.5, 1, 1.5, 1},
        {1, 0.5, 1.5, 30}, {(double)NAN, 1, 2, 3}, {1e9, 1, HUGE_VAL}, {2.5, -2.5, 1e-9, 0}};
    enum { SETS = sizeof sets / sizeof sets[0] };
    for (int i = 0; i < SETS; i++) {
        for (int k = 0; k < SETS; k++) {
            assert_four(four, sets[i]);
            assert_four(four, sets[i]);
            assert_four(four, sets[k]);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_lane_has_the_bits_of_the_interpreter),
        cmocka_unit_test(compiled_lanes_have_the_bits_of_the_interpreter),
        cmocka_unit_test(sines_of_lanes_have_the_bits_of_the_c_library),
        cmocka_unit_test(vector_sines_serve_with_the_gnu_library),
        cmocka_unit_test(four_angles_are_those_of_the_library_however_they_recur),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
