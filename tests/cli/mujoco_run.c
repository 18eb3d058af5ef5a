// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a model in MuJoCo from its first keyframe, and prints the hinges and slides at the end.
// usage: mujoco_run MODEL.xml TIME STEP
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv) {
    char error[500] = "";
    if (argc != 4) {
        return 2;
    }
    mjModel *m = mj_loadXML(argv[1], NULL, error, sizeof error);
    if (!m || m->nkey < 1) {
        fprintf(stderr, "%s\n", m ? "no keyframe" : error);
        return 1;
    }
    mjData *d = mj_makeData(m);
    const double end = strtod(argv[2], NULL);
    m->opt.timestep = strtod(argv[3], NULL);
    mj_resetDataKeyframe(m, d, 0);

    // equalities as stiff as MuJoCo allows: a time constant of two steps, an impedance next to one
    m->opt.tolerance = 0;
    for (int i = 0; i < m->neq; i++) {
        const double impedance[mjNIMP] = {0.9999, 0.9999, 0.001, 0.5, 2};
        m->eq_solref[i * mjNREF] = 2 * m->opt.timestep;
        m->eq_solref[i * mjNREF + 1] = 1;
        mju_copy(&m->eq_solimp[i * mjNIMP], impedance, mjNIMP);
    }
    while (d->time < end - m->opt.timestep / 2) {
        mj_step(m, d);
    }

    // equalities: how many, and the largest violation
    mj_forward(m, d);
    double gap = 0;
    for (int i = 0; i < d->nefc; i++) {
        gap = d->efc_type[i] == mjCNSTR_EQUALITY ? mju_max(gap, mju_abs(d->efc_pos[i])) : gap;
    }
    printf("equalities %d gap %.17g warnings %d\n", m->neq, gap,
           d->warning[mjWARN_BADQACC].number + d->warning[mjWARN_BADQPOS].number);
    for (int j = 0; j < m->njnt; j++) {
        if (m->jnt_type[j] == mjJNT_HINGE || m->jnt_type[j] == mjJNT_SLIDE) {
            printf("%s\t%.17g\n", mj_id2name(m, mjOBJ_JOINT, j), d->qpos[m->jnt_qposadr[j]]);
        }
    }
    mj_deleteData(d);
    mj_deleteModel(m);
    return 0;
}
