"""Numba of the default labeller: arrays in, arrays out.

A point without a label has −1, a label without a point as well.
"""

from kinesphere.labelling.kernels.annealing import anneal as anneal
from kinesphere.labelling.kernels.blocks import block_energies as block_energies
from kinesphere.labelling.kernels.blocks import move_energies as move_energies
from kinesphere.labelling.kernels.costs import linear_terms as linear_terms
from kinesphere.labelling.kernels.costs import pair_costs as pair_costs
from kinesphere.labelling.kernels.costs import pair_energy as pair_energy
from kinesphere.labelling.kernels.exchanges import exchange as exchange
from kinesphere.labelling.kernels.exchanges import exchange_gain as exchange_gain
from kinesphere.labelling.kernels.handed import BASE as BASE
from kinesphere.labelling.kernels.handed import handed_energy as handed_energy
from kinesphere.labelling.kernels.handed import one_quadruple as one_quadruple
from kinesphere.labelling.kernels.handed import point_energies as point_energies
from kinesphere.labelling.kernels.handed import room_to_agree as room_to_agree
from kinesphere.labelling.kernels.searches import descend as descend
from kinesphere.labelling.kernels.searches import least_changes as least_changes
