"""Actors whose truth is known, and ways to spoil what cameras see of them."""

from kinesphere.synthetic.actor import Actor as Actor
from kinesphere.synthetic.actor import make_actor as make_actor
from kinesphere.synthetic.bodies import HUMAN as HUMAN
from kinesphere.synthetic.bodies import PLAYER as PLAYER
from kinesphere.synthetic.creatures import HAND as HAND
from kinesphere.synthetic.creatures import QUADRUPED as QUADRUPED
from kinesphere.synthetic.performance import Performance as Performance
from kinesphere.synthetic.performance import make_performance as make_performance
from kinesphere.synthetic.performance import together as together
from kinesphere.synthetic.plan import BodyPlan as BodyPlan
from kinesphere.synthetic.plan import LimbPlan as LimbPlan
from kinesphere.synthetic.plan import Movement as Movement
from kinesphere.synthetic.soft_tissue import spoil_with_soft_tissue as spoil_with_soft_tissue
from kinesphere.synthetic.spoil import spoil_with_gaps as spoil_with_gaps
from kinesphere.synthetic.spoil import spoil_with_ghosts as spoil_with_ghosts
from kinesphere.synthetic.spoil import spoil_with_noise as spoil_with_noise
from kinesphere.synthetic.spoil import spoil_with_swaps as spoil_with_swaps
from kinesphere.synthetic.spoil import spoil_with_turned_camera as spoil_with_turned_camera
from kinesphere.synthetic.spoil import spoil_with_wrong_unit as spoil_with_wrong_unit
from kinesphere.synthetic.truth import TruthRow as TruthRow
from kinesphere.synthetic.truth import compare_with_truth as compare_with_truth
from kinesphere.synthetic.truth import worst_rows as worst_rows
