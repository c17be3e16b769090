"""One self-contained page that shows what was found."""

from kinesphere.report.axes_words import origins_in_words as origins_in_words
from kinesphere.report.comparison import comparison_html as comparison_html
from kinesphere.report.joint_table import JointRow as JointRow
from kinesphere.report.joint_table import joint_rows as joint_rows
from kinesphere.report.label_table import write_label_table as write_label_table
from kinesphere.report.labelling import labelling_html as labelling_html
from kinesphere.report.notices import Notice as Notice
from kinesphere.report.notices import names_of as names_of
from kinesphere.report.notices import notices as notices
from kinesphere.report.page import report_html as report_html
from kinesphere.report.tiles import rms as rms
from kinesphere.report.wording import counted as counted
from kinesphere.report.wording import finding_in_words as finding_in_words
from kinesphere.report.wording import in_words as in_words
from kinesphere.report.wording import number_in_words as number_in_words
from kinesphere.report.wording import unique as unique
