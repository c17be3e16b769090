"""Films of a moving body from any cameras, with everything about them known."""

from kinesphere.synthetic.film.body_motion import BodyMotion as BodyMotion
from kinesphere.synthetic.film.conditions import CONDITIONS as CONDITIONS
from kinesphere.synthetic.film.conditions import Conditions as Conditions
from kinesphere.synthetic.film.film import Film as Film
from kinesphere.synthetic.film.film import make_film as make_film
from kinesphere.synthetic.film.markers import marker_model as marker_model
from kinesphere.synthetic.film.markers import markers_of as markers_of
from kinesphere.synthetic.film.movements import MOVEMENTS as MOVEMENTS
from kinesphere.synthetic.film.people import another_person as another_person
from kinesphere.synthetic.film.people import stretched as stretched
from kinesphere.synthetic.film.studio import cameras_around as cameras_around
