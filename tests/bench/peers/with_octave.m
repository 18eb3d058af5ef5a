% SPDX-License-Identifier: GPL-3.0-or-later
% FB0 over 10 s by Octave's ode45. Arguments: the six numbers of the start.
1;

function ydot = rhs(t, y)
  l1 = 1; l2 = 2; l3 = 1.8; m1 = 1; m2 = 2; m3 = 1.8; g = 9.81;
  c = cos(y(1:3)); s = sin(y(1:3)); w = y(4:6);
  k = m2 * l1 * l2 / 2; c12 = c(1) * c(2) + s(1) * s(2); s12 = s(1) * c(2) - c(1) * s(2);
  M = [m1 * l1^2 / 3 + m2 * l1^2, k * c12, 0; k * c12, m2 * l2^2 / 3, 0; 0, 0, m3 * l3^2 / 3];
  f = [-k * s12 * w(2)^2 - g * (m1 / 2 + m2) * l1 * c(1);
       k * s12 * w(1)^2 - g * m2 / 2 * l2 * c(2);
       -g * m3 / 2 * l3 * c(3)];
  J = [-l1 * s(1), -l2 * s(2), l3 * s(3); l1 * c(1), l2 * c(2), -l3 * c(3)];
  gamma = [-l1 * c(1) * w(1)^2 - l2 * c(2) * w(2)^2 + l3 * c(3) * w(3)^2;
           -l1 * s(1) * w(1)^2 - l2 * s(2) * w(2)^2 + l3 * s(3) * w(3)^2];
  x = [M, J'; J, zeros(2)] \ [f; -gamma];
  ydot = [w; x(1:3)];
end

x = cellfun(@str2double, argv())(end - 5 : end);
start = [x(1); x(1) + x(2); x(3); x(4); x(4) + x(5); x(6)];
for tolerance = [1e-4, 1e-6, 1e-8, 1e-10]
  opts = odeset("RelTol", tolerance, "AbsTol", tolerance);
  least = Inf;
  for r = 1:2
    begin = cputime();
    [t, y] = ode45(@rhs, [0, 10], start, opts);
    least = min(least, cputime() - begin);
  end
  printf("Octave,ode45,%g,%.9g,%.17g\n", tolerance, least, y(end, 1));
end
