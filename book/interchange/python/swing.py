from math import cos, sqrt

from pendulum import Pendulum

pendulum = Pendulum(g=9.81, l=1.0, c=0.0)
times = [0.1 * k for k in range(50)]
for t, (angle, velocity) in zip(times, pendulum.swing(0.01, times)):
    assert abs(angle - 0.01 * cos(sqrt(9.81) * t)) < 1e-6

try:
    pendulum.swing(0.01, [float("nan")])
except ValueError as error:
    print("as it should:", error)
else:
    raise SystemExit("a time that is no number was taken")
print(Pendulum.equations())
