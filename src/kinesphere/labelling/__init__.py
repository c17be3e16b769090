"""Which marker is which: topological models, label spellings, subjects."""

from kinesphere.labelling.choice import choose_model as choose_model
from kinesphere.labelling.choice import coverage as coverage
from kinesphere.labelling.lock_on import LiveLabeller as LiveLabeller
from kinesphere.labelling.match import match_labels as match_labels
from kinesphere.labelling.models import built_in_model as built_in_model
from kinesphere.labelling.models import built_in_models as built_in_models
from kinesphere.labelling.settings import LabellingSettings as LabellingSettings
from kinesphere.labelling.stage import label as label
from kinesphere.labelling.stage import unlabelled as unlabelled
from kinesphere.labelling.subjects import find_subjects as find_subjects
