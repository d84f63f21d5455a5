"""What the settled bed could cost at best on a machine whose peaks are known (bench/machine_limits.cpp).

Counted by hand in dem/contact_law.hpp and around it; the thesis' law in double precision, no multiply-add (contraction is
off, so that every machine of one instruction set gives the same bits), every lane of every vector full.
"""

# Per contact: distance, normal and relative motion 35, the law 120, torques and sums 24.
FLOPS_A_CONTACT = 179
ROOTS_A_CONTACT = 5  # distance, contact radius, viscosity, stretched spring, spin
QUOTIENTS_A_CONTACT = 6  # normal, half-step damping, sliding, rolling direction, reduced radius and mass
# Per grain: kick, drift, place in the period, largest speed.
FLOPS_A_GRAIN = 45
# Per contact: spring read and written, both rows, index. Per grain: position, velocity, spin, radius, mass read; the
# first three written. Pairs within the skin that do not touch: two rows each. Partners come from the cache.
BYTES_A_CONTACT = 2 * 24 + 12
BYTES_A_GRAIN = 96 + 72
NEIGHBOURS_A_CONTACT = 2  # listed pairs over touching ones
BYTES_A_NEIGHBOUR = 8


def seconds_a_particle_step(contacts_a_grain, limits):
    """Seconds on one core: (arithmetic, roots and quotients, memory)."""
    plain_flops = limits["flops_per_second"] / 2  # a multiply-add counts as two
    arithmetic = (FLOPS_A_CONTACT * contacts_a_grain + FLOPS_A_GRAIN) / plain_flops
    special = contacts_a_grain * (ROOTS_A_CONTACT / limits["roots_per_second"]
                                  + QUOTIENTS_A_CONTACT / limits["quotients_per_second"])
    moved = (BYTES_A_CONTACT + NEIGHBOURS_A_CONTACT * BYTES_A_NEIGHBOUR) * contacts_a_grain + BYTES_A_GRAIN
    return arithmetic, special, moved / limits["triad_bytes_per_second_memory"]


def limit(contacts_a_grain, limits):
    """Particle-steps per second of one core at most: arithmetic and roots wait for each other, memory for neither."""
    arithmetic, special, memory = seconds_a_particle_step(contacts_a_grain, limits)
    return 1 / max(arithmetic + special, memory)


def text(contacts_a_grain, limits, rates):
    """Markdown: the limit, and the share of it that each measured rate {grains: particle-steps/s} reaches."""
    parts = seconds_a_particle_step(contacts_a_grain, limits)
    most = limit(contacts_a_grain, limits)
    lines = [f"Peaks of one core: {limits['flops_per_second'] / 1e9:.0f} GFlop/s with multiply-add, "
             f"{limits['roots_per_second'] / 1e9:.2f}e9 roots/s, {limits['quotients_per_second'] / 1e9:.2f}e9 quotients/s, "
             f"{limits['triad_bytes_per_second_memory'] / 1e9:.1f} GB/s.",
             f"A particle-step with {contacts_a_grain:.2f} contacts needs {1e9 * parts[0]:.1f} ns of arithmetic, "
             f"{1e9 * parts[1]:.1f} ns of roots and quotients, {1e9 * parts[2]:.1f} ns of memory: at most "
             f"{most / 1e6:.0f} million particle-steps/s."]
    lines += [f"{grains} grains: {100 * rate / most:.0f} % of it." for grains, rate in rates.items()]
    return "\n".join(lines) + "\n"
