"""Input decks of the peers for a settled bed: the thesis' contact model in LIGGGHTS, its Hertz-Mindlin part in LAMMPS."""

YOUNG, POISSON, RESTITUTION, FRICTION, ROLLING, COHESION = 0.2e9, 0.3, 0.7, 0.7, 0.15, 9e4
TIME_STEP = 3.592e-8  # [s]
SKIN = 4e-6  # of the neighbour lists [m]

COMMON = """units si
atom_modify map array
boundary p p f
processors * * 1
newton off
{velocities}
neighbor {skin} bin
neigh_modify delay 0 every 10 check yes
read_data {data}
{model}
timestep {time_step}
fix grav all gravity 9.81 vector 0 0 -1
fix integrate all nve/sphere
thermo 1000000
thermo_modify norm no
run {warm_up}
print TIMED
"""


def liggghts(data, steps, blocks, warm_up=100):
    model = "hertz tangential history cohesion sjkr2 rolling_friction cdt"
    text = "atom_style granular\n" + COMMON.format(
        velocities="communicate single vel yes",
        skin=SKIN,
        data=data,
        time_step=TIME_STEP,
        warm_up=warm_up,
        model=f"""fix m1 all property/global youngsModulus peratomtype {YOUNG}
fix m2 all property/global poissonsRatio peratomtype {POISSON}
fix m3 all property/global coefficientRestitution peratomtypepair 1 {RESTITUTION}
fix m4 all property/global coefficientFriction peratomtypepair 1 {FRICTION}
fix m5 all property/global coefficientRollingFriction peratomtypepair 1 {ROLLING}
fix m6 all property/global cohesionEnergyDensity peratomtypepair 1 {COHESION}
pair_style gran model {model}
pair_coeff * *
fix floor all wall/gran model {model} primitive type 1 zplane 0.0""")
    return text + blocks * f"run {steps}\n"


def lammps(data, steps, blocks, warm_up=100):
    """gran/hertz/history takes k_n = 2 E / (3 (1 - nu^2)), k_t = 2 E / ((2 - nu) (1 + nu)) and damping per mass."""
    normal = 2 * YOUNG / (3 * (1 - POISSON**2))
    tangential = 2 * YOUNG / ((2 - POISSON) * (1 + POISSON))
    law = f"{normal:.6g} {tangential:.6g} 1.4e12 0.7e12 {FRICTION} 1"
    text = "atom_style sphere\n" + COMMON.format(
        velocities="comm_modify vel yes",
        skin=SKIN,
        data=data,
        time_step=TIME_STEP,
        warm_up=warm_up,
        model=f"""pair_style gran/hertz/history {law}
pair_coeff * *
fix floor all wall/gran hertz/history {law} zplane 0.0 NULL""")
    return text + blocks * f"run {steps}\n"
