"""Files in and out: a registry that recognises a format by its content, a module per format."""

from kinesphere.io import formats as formats
from kinesphere.io.atomic import replacing as replacing
from kinesphere.io.atomic import replacing_directory as replacing_directory
from kinesphere.io.bvh import write_bvh as write_bvh
from kinesphere.io.csv import read_csv as read_csv
from kinesphere.io.csv import write_csv as write_csv
from kinesphere.io.model_json import model_json_schema as model_json_schema
from kinesphere.io.model_json import read_model as read_model
from kinesphere.io.model_json import write_model as write_model
from kinesphere.io.opensim import write_osim as write_osim
from kinesphere.io.opensim_motion import write_mot as write_mot
from kinesphere.io.parameters_csv import read_parameters as read_parameters
from kinesphere.io.parameters_csv import write_parameters as write_parameters
from kinesphere.io.registry import Format as Format
from kinesphere.io.registry import known_formats as known_formats
from kinesphere.io.registry import read as read
from kinesphere.io.registry import register as register
from kinesphere.io.registry import write as write
from kinesphere.io.segments import read_segments as read_segments
from kinesphere.io.skeleton_json import read_skeleton as read_skeleton
from kinesphere.io.skeleton_json import write_skeleton as write_skeleton
from kinesphere.io.solution import read_solution as read_solution
from kinesphere.io.solution import write_solution as write_solution
from kinesphere.io.trc import read_trc as read_trc
from kinesphere.io.trc import write_trc as write_trc
