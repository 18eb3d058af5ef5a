// SPDX-License-Identifier: GPL-3.0-or-later
// FB0 over 10 s by MuJoCo. The loop is a `connect`, a spring and damper by MuJoCo's design; its
// stiffest setting that MuJoCo allows is a time constant of two steps, with an impedance next to
// one. Its solver gets tolerance zero. Contacts, warnings and sensors are off.
#include <math.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double cpu(void) {
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static const char MODEL[] =
    "<mujoco><compiler angle='radian' inertiafromgeom='false'/>"
    "<option gravity='0 -9.81 0' integrator='%s' timestep='%.17g' tolerance='0' iterations='50'"
    " solver='Newton' cone='elliptic'><flag contact='disable' warmstart='enable'/></option>"
    "<worldbody>"
    "<body name='crank'><joint name='th1' axis='0 0 1'/>"
    "<inertial pos='0.5 0 0' mass='1' diaginertia='1e-6 0.08333333333333333 0.08333333333333333'/>"
    "<body name='coupler' pos='1 0 0'><joint name='a2' axis='0 0 1'/>"
    "<inertial pos='1 0 0' mass='2' diaginertia='1e-6 0.6666666666666666 0.6666666666666666'/>"
    "</body></body>"
    "<body name='rocker' pos='2.2 0 0'><joint name='th3' axis='0 0 1'/>"
    "<inertial pos='0.9 0 0' mass='1.8' diaginertia='1e-6 0.486 0.486'/></body>"
    "</worldbody><equality>"
    "<connect body1='coupler' body2='rocker' anchor='2 0 0' solref='%.17g 1'"
    " solimp='0.9999 0.9999 0.001 0.5 2'/>"
    "</equality></mujoco>";

/// The connect takes its anchor at qpos0, where the loop must be closed: the angles of the start are
/// the reference angles of the hinges.
static mjModel *load(const char *integrator, double h, const double *q) {
    char text[4096], placed[8192], error[500];
    snprintf(text, sizeof text, MODEL, integrator, h, 2 * h);

    // bodies turned into the pose of the start, so that qpos = 0 there
    const double half[3] = {q[0] / 2, q[1] / 2, q[2] / 2};
    const char *names[3] = {"name='crank'", "name='coupler'", "name='rocker'"};
    const char *from = text;
    char *to = placed;
    for (int i = 0; i < 3; i++) {
        const char *at = strstr(from, names[i]);
        const size_t n = (size_t)(at - from);
        memcpy(to, from, n);
        to += n;
        to += sprintf(to, "%s quat='%.17g 0 0 %.17g'", names[i], cos(half[i]), sin(half[i]));
        from = at + strlen(names[i]);
    }
    strcpy(to, from);

    mjVFS vfs;
    mj_defaultVFS(&vfs);
    const int size = (int)strlen(placed);
    mj_makeEmptyFileVFS(&vfs, "fb0.xml", size);
    memcpy(vfs.filedata[0], placed, (size_t)size);
    mjModel *m = mj_loadXML("fb0.xml", &vfs, error, sizeof error);
    if (!m) {
        fprintf(stderr, "mujoco: %s\n", error);
        exit(3);
    }
    return m;
}

int main(int argc, char **argv) {
    static const double steps[] = {1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5};
    static const char *const integrators[] = {"RK4", "implicit"};
    if (argc < 7) {
        fprintf(stderr, "usage: mujoco q1 q2 q3 v1 v2 v3\n");
        return 3;
    }
    double q[3], v[3];
    for (int i = 0; i < 3; i++) {
        q[i] = atof(argv[1 + i]);
        v[i] = atof(argv[4 + i]);
    }
    for (int k = 0; k < 2; k++) {
        for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
            mjModel *m = load(integrators[k], steps[i], q);
            mjData *d = mj_makeData(m);
            double least = HUGE_VAL;
            for (int r = 0; r < 3; r++) {
                mj_resetData(m, d);
                for (int j = 0; j < 3; j++) {
                    d->qvel[j] = v[j];
                }
                const double begin = cpu();
                for (long n = lround(10 / steps[i]); n > 0; n--) {
                    mj_step(m, d);
                }
                least = fmin(least, cpu() - begin);
            }
            printf("MuJoCo,%s,%g,%.9g,%.17g\n", integrators[k], steps[i], least, q[0] + d->qpos[0]);
            mj_deleteData(d);
            mj_deleteModel(m);
        }
    }
    return 0;
}
