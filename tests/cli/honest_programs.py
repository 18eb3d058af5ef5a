# SPDX-License-Identifier: GPL-3.0-or-later
"""An honest class: ten programs of the four-bar and six of the double pendulum, each by a way of thinking of its own.

Statements in C for the parts of `export SCENE --language c --blanks`, by student.
"""

FOUR_BAR = {
    "direct": """
    mass[0][0] = m1*l1*l1/3 + m2*l1*l1;
    mass[0][1] = m2*l1*l2/2*cos(th1 - theta_coupler);
    mass[1][0] = mass[0][1];
    mass[1][1] = m2*l2*l2/3;
    mass[2][2] = m3*l3*l3/3;
    force[0] = -m2*l1*l2/2*sin(th1 - theta_coupler)*omega_coupler*omega_coupler - (m1/2 + m2)*g*l1*cos(th1);
    force[1] = m2*l1*l2/2*sin(th1 - theta_coupler)*w1*w1 - m2*g*l2/2*cos(theta_coupler);
    force[2] = -m3*g*l3/2*cos(th3);
    jacobian[0][0] = -l1*sin(th1);
    jacobian[0][1] = -l2*sin(theta_coupler);
    jacobian[0][2] = l3*sin(th3);
    jacobian[1][0] = l1*cos(th1);
    jacobian[1][1] = l2*cos(theta_coupler);
    jacobian[1][2] = -l3*cos(th3);
    bias[0] = -l1*cos(th1)*w1*w1 - l2*cos(theta_coupler)*omega_coupler*omega_coupler + l3*cos(th3)*w3*w3;
    bias[1] = -l1*sin(th1)*w1*w1 - l2*sin(theta_coupler)*omega_coupler*omega_coupler + l3*sin(th3)*w3*w3;
""",
    "direct-too": """
    // Jacobian first, as in the lecture
    jacobian[0][0] = -l1*sin(th1);
    jacobian[1][0] = l1*cos(th1);
    jacobian[0][1] = -l2*sin(theta_coupler);
    jacobian[1][1] = l2*cos(theta_coupler);
    jacobian[0][2] = l3*sin(th3);
    jacobian[1][2] = -l3*cos(th3);
    bias[0] = -(l1*pow(w1, 2)*cos(th1) + l2*pow(omega_coupler, 2)*cos(theta_coupler) - l3*pow(w3, 2)*cos(th3));
    bias[1] = -(l1*pow(w1, 2)*sin(th1) + l2*pow(omega_coupler, 2)*sin(theta_coupler) - l3*pow(w3, 2)*sin(th3));
    mass[0][0] = (m1/3 + m2)*pow(l1, 2);
    mass[1][1] = m2*pow(l2, 2)/3;
    mass[2][2] = m3*pow(l3, 2)/3;
    mass[0][1] = mass[1][0] = 0.5*m2*l1*l2*cos(th1 - theta_coupler);
    force[0] = -0.5*m2*l1*l2*pow(omega_coupler, 2)*sin(th1 - theta_coupler) - g*l1*cos(th1)*(m1/2 + m2);
    force[1] = 0.5*m2*l1*l2*pow(w1, 2)*sin(th1 - theta_coupler) - 0.5*m2*g*l2*cos(theta_coupler);
    force[2] = -0.5*m3*g*l3*cos(th3);
""",
    "short-names": """
    const double s1 = sin(th1), c1 = cos(th1), s2 = sin(theta_coupler), c2 = cos(theta_coupler), s3 = sin(th3), c3 = cos(th3);
    const double d = th1 - theta_coupler;
    const double h = m2*l1*l2/2;
    mass[0][0] = l1*l1*(m1/3 + m2);
    mass[0][1] = mass[1][0] = h*cos(d);
    mass[1][1] = m2*l2*l2/3;
    mass[2][2] = m3*l3*l3/3;
    force[0] = -h*sin(d)*omega_coupler*omega_coupler - g*l1*c1*(m1/2 + m2);
    force[1] = h*sin(d)*w1*w1 - g*m2*l2*c2/2;
    force[2] = -g*m3*l3*c3/2;
    jacobian[0][0] = -l1*s1;
    jacobian[0][1] = -l2*s2;
    jacobian[0][2] = l3*s3;
    jacobian[1][0] = l1*c1;
    jacobian[1][1] = l2*c2;
    jacobian[1][2] = -l3*c3;
    bias[0] = -l1*c1*w1*w1 - l2*c2*omega_coupler*omega_coupler + l3*c3*w3*w3;
    bias[1] = -l1*s1*w1*w1 - l2*s2*omega_coupler*omega_coupler + l3*s3*w3*w3;
""",
    "shorter-names": """
    double c1 = cos(th1);
    double s1 = sin(th1);
    double cc = cos(theta_coupler);
    double sc = sin(theta_coupler);
    double c3 = cos(th3);
    double s3 = sin(th3);
    double c12 = c1*cc + s1*sc;
    double s12 = s1*cc - c1*sc;
    // moments of inertia about the pivots
    double I1 = m1*l1*l1/3;
    double I2 = m2*l2*l2/3;
    double I3 = m3*l3*l3/3;
    mass[0][0] = I1 + m2*l1*l1;
    mass[0][1] = m2*l1*l2*c12/2;
    mass[1][0] = m2*l1*l2*c12/2;
    mass[1][1] = I2;
    mass[2][2] = I3;
    double G1 = -m1*g*l1*c1/2 - m2*g*l1*c1;
    double G2 = -m2*g*l2*cc/2;
    double G3 = -m3*g*l3*c3/2;
    force[0] = G1 - m2*l1*l2*s12*omega_coupler*omega_coupler/2;
    force[1] = G2 + m2*l1*l2*s12*w1*w1/2;
    force[2] = G3;
    jacobian[0][0] = -l1*s1;
    jacobian[0][1] = -l2*sc;
    jacobian[0][2] = l3*s3;
    jacobian[1][0] = l1*c1;
    jacobian[1][1] = l2*cc;
    jacobian[1][2] = -l3*c3;
    bias[0] = l3*c3*w3*w3 - l1*c1*w1*w1 - l2*cc*omega_coupler*omega_coupler;
    bias[1] = l3*s3*w3*w3 - l1*s1*w1*w1 - l2*sc*omega_coupler*omega_coupler;
""",
    "centres": """
    // M = sum over bodies of m Jc' Jc + I w w', with the centres of mass
    double X[3][3] = {{-l1/2*sin(th1), 0, 0}, {-l1*sin(th1), -l2/2*sin(theta_coupler), 0}, {0, 0, -l3/2*sin(th3)}};
    double Y[3][3] = {{l1/2*cos(th1), 0, 0}, {l1*cos(th1), l2/2*cos(theta_coupler), 0}, {0, 0, l3/2*cos(th3)}};
    double m[3] = {m1, m2, m3}, len[3] = {l1, l2, l3};
    double ax[3] = {-l1/2*cos(th1)*w1*w1, -l1*cos(th1)*w1*w1 - l2/2*cos(theta_coupler)*omega_coupler*omega_coupler, -l3/2*cos(th3)*w3*w3};
    double ay[3] = {-l1/2*sin(th1)*w1*w1, -l1*sin(th1)*w1*w1 - l2/2*sin(theta_coupler)*omega_coupler*omega_coupler, -l3/2*sin(th3)*w3*w3};
    for (int b = 0; b < 3; b++) {
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                mass[i][j] += m[b]*(X[b][i]*X[b][j] + Y[b][i]*Y[b][j]);
            }
            force[i] -= m[b]*(X[b][i]*ax[b] + Y[b][i]*(ay[b] + g));
        }
        mass[b][b] += m[b]*len[b]*len[b]/12;
    }
    for (int j = 0; j < 3; j++) {
        const double sign = j < 2 ? 1 : -1;
        jacobian[0][j] = -sign*len[j]*sin(q[j]);
        jacobian[1][j] = sign*len[j]*cos(q[j]);
        bias[0] -= sign*len[j]*cos(q[j])*v[j]*v[j];
        bias[1] -= sign*len[j]*sin(q[j])*v[j]*v[j];
    }
""",
    "loops": """
    const double length[NV] = {l1, l2, -l3};
    const double own[NV] = {m1/3 + m2, m2/3, m3/3};
    const double pull[NV] = {m1/2 + m2, m2/2, -m3/2};
    for (int i = 0; i < NV; i++) {
        mass[i][i] = own[i]*length[i]*length[i];
        force[i] = -g*pull[i]*length[i]*cos(q[i]);
        jacobian[0][i] = -length[i]*sin(q[i]);
        jacobian[1][i] = length[i]*cos(q[i]);
        bias[0] -= length[i]*cos(q[i])*v[i]*v[i];
        bias[1] -= length[i]*sin(q[i])*v[i]*v[i];
    }
    const double couple = m2*l1*l2/2;
    mass[0][1] = mass[1][0] = couple*cos(q[0] - q[1]);
    force[0] -= couple*sin(q[0] - q[1])*v[1]*v[1];
    force[1] += couple*sin(q[0] - q[1])*v[0]*v[0];
""",
    "pieces": """
    double T1 = 0.5*l1*m1;
    double T2 = 0.5*l2*m2;
    double T3 = 0.5*l3*m3;
    double cosdiff = cos(theta_coupler - th1);
    double sindiff = sin(theta_coupler - th1);
    mass[0][0] = T1*l1*2.0/3.0 + m2*l1*l1;
    mass[1][1] = T2*l2*2.0/3.0;
    mass[2][2] = T3*l3*2.0/3.0;
    mass[0][1] = T2*l1*cosdiff;
    mass[1][0] = T2*l1*cosdiff;
    double w1sq = w1*w1;
    double wcsq = omega_coupler*omega_coupler;
    double w3sq = w3*w3;
    force[0] = T2*l1*sindiff*wcsq;
    force[1] = -T2*l1*sindiff*w1sq;
    force[0] -= (T1 + m2*l1)*g*cos(th1);
    force[1] -= T2*g*cos(theta_coupler);
    force[2] = -T3*g*cos(th3);
    double px = l1*cos(th1), py = l1*sin(th1);
    double rx = l2*cos(theta_coupler), ry = l2*sin(theta_coupler);
    double sx = l3*cos(th3), sy = l3*sin(th3);
    jacobian[0][0] = -py;
    jacobian[0][1] = -ry;
    jacobian[0][2] = sy;
    jacobian[1][0] = px;
    jacobian[1][1] = rx;
    jacobian[1][2] = -sx;
    bias[0] = sx*w3sq - px*w1sq - rx*wcsq;
    bias[1] = sy*w3sq - py*w1sq - ry*wcsq;
""",
    "christoffel": """
    double a = (1.0/3.0)*m1*l1*l1 + m2*l1*l1;
    double b = 0.5*m2*l1*l2;
    double c = (1.0/3.0)*m2*l2*l2;
    double e = (1.0/3.0)*m3*l3*l3;
    double M[3][3] = {{a, b*cos(th1 - theta_coupler), 0}, {b*cos(th1 - theta_coupler), c, 0}, {0, 0, e}};
    memcpy(mass, M, sizeof M);
    // dM01/dth1 = -b sin, dM01/dthc = +b sin: C v by Christoffel's symbols
    double dM01_1 = -b*sin(th1 - theta_coupler);
    double dM01_2 = b*sin(th1 - theta_coupler);
    double C0 = dM01_2*omega_coupler*omega_coupler;
    double C1 = dM01_1*w1*w1;
    double V0 = g*(0.5*m1*l1*cos(th1) + m2*l1*cos(th1));
    double V1 = g*0.5*m2*l2*cos(theta_coupler);
    double V2 = g*0.5*m3*l3*cos(th3);
    force[0] = -C0 - V0;
    force[1] = -C1 - V1;
    force[2] = -V2;
    double J[2][3] = {{-l1*sin(th1), -l2*sin(theta_coupler), l3*sin(th3)}, {l1*cos(th1), l2*cos(theta_coupler), -l3*cos(th3)}};
    memcpy(jacobian, J, sizeof J);
    double Jdot[2][3] = {{-l1*cos(th1)*w1, -l2*cos(theta_coupler)*omega_coupler, l3*cos(th3)*w3}, {-l1*sin(th1)*w1, -l2*sin(theta_coupler)*omega_coupler, l3*sin(th3)*w3}};
    for (int i = 0; i < 2; i++) {
        bias[i] = Jdot[i][0]*w1 + Jdot[i][1]*omega_coupler + Jdot[i][2]*w3;
    }
""",
    "terse": """
    mass[0][0] = l1*l1*(m1 + 3*m2)/3, mass[1][1] = l2*l2*m2/3, mass[2][2] = l3*l3*m3/3;
    mass[1][0] = mass[0][1] = l1*l2*m2*cos(theta_coupler - th1)/2;
    force[0] = l1*l2*m2*sin(theta_coupler - th1)*v[1]*v[1]/2 - l1*(m1 + 2*m2)*g*cos(th1)/2;
    force[1] = -l1*l2*m2*sin(theta_coupler - th1)*v[0]*v[0]/2 - l2*m2*g*cos(theta_coupler)/2;
    force[2] = -l3*m3*g*cos(th3)/2;
    const double jx[] = {-l1*sin(q[0]), -l2*sin(q[1]), l3*sin(q[2])}, jy[] = {l1*cos(q[0]), l2*cos(q[1]), -l3*cos(q[2])};
    for (int k = 0; k < 3; k++) {
        jacobian[0][k] = jx[k], jacobian[1][k] = jy[k];
        bias[0] -= jy[k]*v[k]*v[k], bias[1] += jx[k]*v[k]*v[k];
    }
""",
    "careful": """
    /* --- trigonometry --- */
    const double sin_crank = sin(th1);
    const double cos_crank = cos(th1);
    const double sin_coupler = sin(theta_coupler);
    const double cos_coupler = cos(theta_coupler);
    const double sin_rocker = sin(th3);
    const double cos_rocker = cos(th3);
    /* --- inertia about the centre, and Steiner --- */
    const double inertia_crank = m1*l1*l1/12 + m1*(l1/2)*(l1/2);
    const double inertia_coupler = m2*l2*l2/12 + m2*(l2/2)*(l2/2);
    const double inertia_rocker = m3*l3*l3/12 + m3*(l3/2)*(l3/2);
    mass[0][0] = inertia_crank + m2*l1*l1;
    mass[0][1] = m2*l1*(l2/2)*(cos_crank*cos_coupler + sin_crank*sin_coupler);
    mass[1][0] = mass[0][1];
    mass[1][1] = inertia_coupler;
    mass[2][2] = inertia_rocker;
    /* --- centripetal terms --- */
    const double coupling = m2*l1*(l2/2)*(sin_crank*cos_coupler - cos_crank*sin_coupler);
    force[0] = -coupling*omega_coupler*omega_coupler;
    force[1] = coupling*w1*w1;
    /* --- weight --- */
    force[0] += -m1*g*(l1/2)*cos_crank - m2*g*l1*cos_crank;
    force[1] += -m2*g*(l2/2)*cos_coupler;
    force[2] += -m3*g*(l3/2)*cos_rocker;
    /* --- the loop --- */
    jacobian[0][0] = -l1*sin_crank;
    jacobian[1][0] = l1*cos_crank;
    jacobian[0][1] = -l2*sin_coupler;
    jacobian[1][1] = l2*cos_coupler;
    jacobian[0][2] = l3*sin_rocker;
    jacobian[1][2] = -l3*cos_rocker;
    bias[0] = -(l1*cos_crank*w1*w1 + l2*cos_coupler*omega_coupler*omega_coupler) + l3*cos_rocker*w3*w3;
    bias[1] = -(l1*sin_crank*w1*w1 + l2*sin_coupler*omega_coupler*omega_coupler) + l3*sin_rocker*w3*w3;
""",
}

DOUBLE_PENDULUM = {
    "direct": """
    mass[0][0] = m1*l1*l1/3 + m2*l1*l1;
    mass[0][1] = m2*l1*l2/2*cos(th1 - theta_lower_rod);
    mass[1][0] = mass[0][1];
    mass[1][1] = m2*l2*l2/3;
    force[0] = -m2*l1*l2/2*sin(th1 - theta_lower_rod)*omega_lower_rod*omega_lower_rod - (m1/2 + m2)*g*l1*sin(th1);
    force[1] = m2*l1*l2/2*sin(th1 - theta_lower_rod)*w1*w1 - m2*g*l2/2*sin(theta_lower_rod);
""",
    "powers": """
    double delta = th1 - theta_lower_rod;
    mass[0][0] = (m1/3 + m2)*pow(l1, 2);
    mass[0][1] = mass[1][0] = 0.5*m2*l1*l2*cos(delta);
    mass[1][1] = m2*pow(l2, 2)/3;
    force[0] = -0.5*m2*l1*l2*sin(delta)*pow(omega_lower_rod, 2) - 0.5*g*l1*sin(th1)*(m1 + 2*m2);
    force[1] = 0.5*m2*l1*l2*sin(delta)*pow(w1, 2) - 0.5*g*m2*l2*sin(theta_lower_rod);
""",
    "names": """
    double h = m2*l1*l2/2;
    double d = th1 - theta_lower_rod;
    mass[0][0] = l1*l1*(m1/3 + m2);
    mass[0][1] = h*cos(d);
    mass[1][0] = h*cos(d);
    mass[1][1] = m2*l2*l2/3;
    force[0] = -h*sin(d)*omega_lower_rod*omega_lower_rod - g*l1*(m1/2 + m2)*sin(th1);
    force[1] = h*sin(d)*w1*w1 - g*l2*m2/2*sin(theta_lower_rod);
""",
    "inertia": """
    double I1 = m1*l1*l1/3;
    double I2 = m2*l2*l2/3;
    double c12 = cos(th1)*cos(theta_lower_rod) + sin(th1)*sin(theta_lower_rod);
    double s12 = sin(th1)*cos(theta_lower_rod) - cos(th1)*sin(theta_lower_rod);
    mass[0][0] = I1 + m2*l1*l1;
    mass[0][1] = m2*l1*l2*c12/2;
    mass[1][0] = m2*l1*l2*c12/2;
    mass[1][1] = I2;
    double G1 = -m1*g*l1*sin(th1)/2 - m2*g*l1*sin(th1);
    double G2 = -m2*g*l2*sin(theta_lower_rod)/2;
    force[0] = G1 - m2*l1*l2*s12*omega_lower_rod*omega_lower_rod/2;
    force[1] = G2 + m2*l1*l2*s12*w1*w1/2;
""",
    "centres": """
    double X[2][2] = {{l1/2*cos(th1), 0}, {l1*cos(th1), l2/2*cos(theta_lower_rod)}};
    double Y[2][2] = {{l1/2*sin(th1), 0}, {l1*sin(th1), l2/2*sin(theta_lower_rod)}};
    double ax[2] = {-l1/2*sin(th1)*w1*w1, -l1*sin(th1)*w1*w1 - l2/2*sin(theta_lower_rod)*omega_lower_rod*omega_lower_rod};
    double ay[2] = {l1/2*cos(th1)*w1*w1, l1*cos(th1)*w1*w1 + l2/2*cos(theta_lower_rod)*omega_lower_rod*omega_lower_rod};
    double m[2] = {m1, m2}, len[2] = {l1, l2};
    for (int b = 0; b < 2; b++) {
        for (int i = 0; i < 2; i++) {
            for (int j = 0; j < 2; j++) mass[i][j] += m[b]*(X[b][i]*X[b][j] + Y[b][i]*Y[b][j]);
            force[i] -= m[b]*(X[b][i]*ax[b] + Y[b][i]*(ay[b] + g));
        }
        mass[b][b] += m[b]*len[b]*len[b]/12;
    }
""",
    "terse": """
    mass[0][0] = l1*l1*(m1 + 3*m2)/3, mass[1][1] = l2*l2*m2/3;
    mass[1][0] = mass[0][1] = l1*l2*m2*cos(theta_lower_rod - th1)/2;
    force[0] = l1*l2*m2*sin(theta_lower_rod - th1)*v[1]*v[1]/2 - l1*(m1 + 2*m2)*g*sin(th1)/2;
    force[1] = -l1*l2*m2*sin(theta_lower_rod - th1)*v[0]*v[0]/2 - l2*m2*g*sin(theta_lower_rod)/2;
""",
}


def fill(blank, statements):
    """The program with blanks in C, with these statements in their place."""
    begin, end = blank.index("    // YOUR PART 1"), blank.index("    const double k1")
    return blank[:begin] + "    {" + statements + "    }\n" + blank[end:]
