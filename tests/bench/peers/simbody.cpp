// SPDX-License-Identifier: GPL-3.0-or-later
// FB0 over 10 s by Simbody: three pins, and the loop as two points in planes, which is its cheapest
// way to close a planar loop. Constraint tolerance a tenth of the accuracy; the projection that
// Simbody makes after a step is part of its integrators.
#include <Simbody.h>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

using namespace SimTK;

static double cpu() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

static Body::Rigid rod(double mass, double length) {
    const double about_com = mass * length * length / 12;
    const Vec3 com(length / 2, 0, 0);
    return Body::Rigid(
        MassProperties(mass, com, Inertia(1e-6, about_com, about_com).shiftFromMassCenter(com, mass)));
}

int main(int argc, char **argv) {
    if (argc < 7) {
        std::fprintf(stderr, "usage: simbody q1 q2 q3 v1 v2 v3\n");
        return 3;
    }
    MultibodySystem system;
    SimbodyMatterSubsystem matter(system);
    GeneralForceSubsystem forces(system);
    Force::UniformGravity gravity(forces, matter, Vec3(0, -9.81, 0));

    MobilizedBody::Pin crank(matter.Ground(), Transform(), rod(1, 1), Transform());
    MobilizedBody::Pin coupler(crank, Transform(Vec3(1, 0, 0)), rod(2, 2), Transform());
    MobilizedBody::Pin rocker(matter.Ground(), Transform(Vec3(2.2, 0, 0)), rod(1.8, 1.8),
                              Transform());
    // the tip of the coupler lies in two planes of the rocker through its tip
    Constraint::PointInPlane x(rocker, UnitVec3(1, 0, 0), 1.8, coupler, Vec3(2, 0, 0));
    Constraint::PointInPlane y(rocker, UnitVec3(0, 1, 0), 0, coupler, Vec3(2, 0, 0));
    system.realizeTopology();

    static const double accuracies[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};
    for (int kind = 0; kind < 2; kind++) {
        for (double accuracy : accuracies) {
            double least = HUGE_VAL, angle = 0;
            for (int r = 0; r < 3; r++) {
                State state = system.getDefaultState();
                MobilizedBody::Pin *pins[3] = {&crank, &coupler, &rocker};
                for (int i = 0; i < 3; i++) {
                    pins[i]->setOneQ(state, 0, std::atof(argv[1 + i]));
                    pins[i]->setOneU(state, 0, std::atof(argv[4 + i]));
                }
                RungeKuttaMersonIntegrator merson(system);
                RungeKuttaFeldbergIntegrator feldberg(system);
                Integrator &integrator = kind ? static_cast<Integrator &>(feldberg)
                                              : static_cast<Integrator &>(merson);
                integrator.setAccuracy(accuracy);
                integrator.setConstraintTolerance(accuracy / 10);
                TimeStepper stepper(system, integrator);
                stepper.initialize(state);
                const double begin = cpu();
                stepper.stepTo(10);
                least = std::fmin(least, cpu() - begin);
                angle = crank.getOneQ(stepper.getState(), 0);
            }
            std::printf("Simbody,%s,%g,%.9g,%.17g\n",
                        kind ? "RungeKuttaFeldberg" : "RungeKuttaMerson", accuracy, least, angle);
        }
    }
    return 0;
}
