#!/usr/bin/python3
"""What the time step and single precision do to the energy of an elastic gas, collision by collision.

Pairs of the gas of tests/verification/dem/validation_gas.cpp (radius 1.5 mm, E 1e7 Pa, nu 0.25, 2500 kg/m3, 40 steps a
contact at 1 m/s) meet at random: their normal speed as in a Maxwell gas, the impact parameter uniform over the cross
section, the first step anywhere before the contact. Velocity-Verlet takes each through its contact, once with the force in
double precision and once as the contact loop finds it, overlap and force in single precision. Prints the change of energy
a collision, in units of m/4 (1 m/s)^2, and what a million of them are of the energy of 500 spheres.

    tools/validation/elastic_gas_error.py
"""

import numpy as np

RADIUS, MODULUS, POISSON, DENSITY = 0.0015, 1e7, 0.25, 2500.0
SPHERES, COLLISIONS, STEPS_A_CONTACT = 500, 1e6, 40

MASS = DENSITY * 4 / 3 * np.pi * RADIUS**3
REDUCED_MASS = MASS / 2
EFFECTIVE_MODULUS = MODULUS / (1 - POISSON**2) / 2
EFFECTIVE_RADIUS = RADIUS / 2
REACH = 2 * RADIUS
# Of Hertz's impact at 1 m/s.
CONTACT_TIME = 2.94328 * (15 / 16 * REDUCED_MASS / (np.sqrt(EFFECTIVE_RADIUS) * EFFECTIVE_MODULUS)) ** 0.4
STEP = CONTACT_TIME / STEPS_A_CONTACT


def start(count, rng):
    """Separations and relative velocities just before contact, in a plane."""
    normal = np.maximum(np.sqrt(2 / 3) * np.sqrt(-2 * np.log(1 - rng.random(count))), 0.02)
    impact_parameter = 0.999 * REACH * np.sqrt(rng.random(count))
    across = np.minimum(normal * impact_parameter / np.sqrt(REACH**2 - impact_parameter**2), 3)
    angle = 2 * np.pi * rng.random(count)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    place = np.stack([REACH + normal * STEP * rng.random(count), np.zeros(count)])
    return np.einsum("ijn,jn->in", turn, place), np.einsum("ijn,jn->in", turn, np.stack([-normal, across]))


def changes_of_energy(number, count, seed):
    """Of `count` collisions with forces in precision `number`; those still in contact after 260 steps are left out."""
    place, velocity = start(count, np.random.default_rng(seed))
    before = (velocity**2).sum(0)
    for _ in range(260):
        gap = REACH**2 - (place**2).sum(0)
        d = place.astype(number)
        distance = np.sqrt((d * d).sum(0))
        overlap = np.maximum(gap, 0).astype(number) / (distance + number(REACH))
        force = number(4 / 3) * number(EFFECTIVE_MODULUS) * np.sqrt(number(EFFECTIVE_RADIUS) * overlap) * overlap
        velocity = velocity + (force / distance).astype(float) * place * (STEP / REDUCED_MASS)
        place = place + velocity * STEP
    return ((velocity**2).sum(0) - before)[gap < 0]


def main():
    of_all = SPHERES * MASS / REDUCED_MASS
    for number in (np.float64, np.float32):
        e = np.concatenate([changes_of_energy(number, 40000, seed) for seed in range(50)])
        error = e.std() / np.sqrt(e.size)
        print(f"{number.__name__}: {e.size} collisions, mean change {e.mean():.4g} +- {error:.2g}, spread {e.std():.3g}; "
              f"of a million: {e.mean() * COLLISIONS / of_all:.4g} +- {error * COLLISIONS / of_all:.2g}, random walk "
              f"{e.std() * np.sqrt(COLLISIONS) / of_all:.2g}")


if __name__ == "__main__":
    main()
