// SPDX-License-Identifier: GPL-3.0-or-later
// A first program with the library: load a four-bar, look at it, run it, compare methods.
//
//     gcc example.c $(pkg-config --cflags --libs holonom) -o example
//     HOLONOM_HOME=$(pkg-config --variable=home holonom) ./example
#include <holonom.h>

#include <stdio.h>
#include <stdlib.h>

static void fail(const holonom_fault *fault) {
    fprintf(stderr, "%s%s%s (%s)\n", fault->where, fault->where[0] ? ": " : "", fault->message,
            fault->hint);
    exit(1);
}

/// Degrees of freedom and the assembled start.
static void show(const holonom_mechanism *m) {
    const holonom_sizes sizes = holonom_get_sizes(m);
    double *q = calloc(2 * (size_t)sizes.coordinates, sizeof *q), *v = q + sizes.coordinates;
    if (!q) {
        exit(1);
    }
    holonom_start(m, q, v);
    printf("%d coordinates - %d constraints + %d redundant = %d degree of freedom\n",
           sizes.coordinates, sizes.constraints, sizes.redundant, sizes.dof);
    for (int i = 0; i < sizes.coordinates; i++) {
        printf("%s = %.6f rad, %s = %.6f rad/s\n", holonom_coordinate_name(m, i), q[i],
               holonom_rate_name(m, i), v[i]);
    }
    free(q);
}

/// One run, sampled four times.
static void run(const holonom_mechanism *m, const char *method) {
    holonom_fault fault;
    holonom_run *r;
    if (holonom_run_create(m, method, &r, &fault) != HOLONOM_OK) {
        fail(&fault);
    }
    for (int k = 1; k <= 4; k++) {
        holonom_sample s;
        if (holonom_run_to(r, 0.5 * k, &s, &fault) != HOLONOM_OK) {
            fail(&fault);
        }
        printf("t = %.1f s: %s = %.6f rad, gap %.1e m\n", s.t, holonom_coordinate_name(m, 0),
               s.q[0], s.gap);
    }
    holonom_run_free(r);
}

int main(void) {
    static const char *const methods[] = {"index1@rk4:h=1e-2", "baumgarte@rk4:h=1e-2",
                                          "projection@rk4:h=1e-2"};
    enum { N = sizeof methods / sizeof *methods };
    holonom_mechanism *m;
    holonom_fault fault;
    holonom_result results[N];

    // a shipped scene, with a link of another length
    if (holonom_load("four-bar", &m, &fault) != HOLONOM_OK ||
        holonom_set(m, "l1", 0.4, &fault) != HOLONOM_OK) {
        fail(&fault);
    }
    show(m);
    run(m, "projection@rk4:h=1e-3");

    // what three methods make of ten seconds
    if (holonom_compare(m, methods, N, 10, results, &fault) != HOLONOM_OK) {
        fail(&fault);
    }
    for (int i = 0; i < N; i++) {
        printf("%-22s gap %.1e m, %lld steps, %.0f operations%s%s\n", methods[i], results[i].gap,
               results[i].steps, results[i].operations, results[i].status == HOLONOM_OK ? "" : ": ",
               results[i].reason);
    }
    holonom_free(m);
    return 0;
}
