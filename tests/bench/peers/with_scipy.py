# SPDX-License-Identifier: GPL-3.0-or-later
"""FB0 over 10 s by SciPy's solve_ivp on accelerations written with the mathematics of floats, which for three
coordinates is quicker than arrays."""
import sys
import time
from math import cos, inf, sin

from scipy.integrate import solve_ivp

L1, L2, L3, M1, M2, M3, G = 1.0, 2.0, 1.8, 1.0, 2.0, 1.8, 9.81
K = M2 * L1 * L2 / 2
M11, M22, M33 = M1 * L1 * L1 / 3 + M2 * L1 * L1, M2 * L2 * L2 / 3, M3 * L3 * L3 / 3


def rhs(_, y):
    q1, q2, q3, w1, w2, w3 = y
    c1, s1, c2, s2, c3, s3 = cos(q1), sin(q1), cos(q2), sin(q2), cos(q3), sin(q3)
    s12, m12 = s1 * c2 - c1 * s2, K * (c1 * c2 + s1 * s2)
    f1 = -K * s12 * w2 * w2 - G * (M1 / 2 + M2) * L1 * c1
    f2, f3 = K * s12 * w1 * w1 - G * M2 / 2 * L2 * c2, -G * M3 / 2 * L3 * c3
    a1, b1, a2, b2, a3, b3 = L1 * c1, L1 * s1, L2 * c2, L2 * s2, L3 * c3, L3 * s3
    gx, gy = a3 * w3 * w3 - a1 * w1 * w1 - a2 * w2 * w2, b3 * w3 * w3 - b1 * w1 * w1 - b2 * w2 * w2
    r = 1 / (M11 * M22 - m12 * m12)
    i11, i12, i22 = M22 * r, -m12 * r, M11 * r
    x1, x2, x3 = -(i11 * b1 + i12 * b2), -(i12 * b1 + i22 * b2), b3 / M33
    y1, y2, y3 = i11 * a1 + i12 * a2, i12 * a1 + i22 * a2, -a3 / M33
    z1, z2, z3 = i11 * f1 + i12 * f2, i12 * f1 + i22 * f2, f3 / M33
    sxx, sxy, syy = b3 * x3 - b1 * x1 - b2 * x2, b3 * y3 - b1 * y1 - b2 * y2, a1 * y1 + a2 * y2 - a3 * y3
    rx, ry = -gx - (b3 * z3 - b1 * z1 - b2 * z2), -gy - (a1 * z1 + a2 * z2 - a3 * z3)
    d = 1 / (sxx * syy - sxy * sxy)
    p, s = (syy * rx - sxy * ry) * d, (sxx * ry - sxy * rx) * d
    return [w1, w2, w3, z1 + x1 * p + y1 * s, z2 + x2 * p + y2 * s, z3 + x3 * p + y3 * s]


def main():
    q = [float(x) for x in sys.argv[1:7]]
    start = [q[0], q[0] + q[1], q[2], q[3], q[3] + q[4], q[5]]
    for method in ("DOP853", "LSODA"):
        for tolerance in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12):
            least, angle = inf, 0
            for _ in range(3):
                begin = time.thread_time()
                end = solve_ivp(rhs, (0, 10), start, method=method, rtol=tolerance, atol=tolerance)
                least = min(least, time.thread_time() - begin)
                angle = end.y[0, -1]
            print(f"SciPy,{method},{tolerance:g},{least:.9g},{angle:.17g}")


main()
