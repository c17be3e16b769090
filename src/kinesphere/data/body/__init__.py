"""The body that comes with the program: made by ``tools/export_body.py`` from CC0 assets."""

from kinesphere.data.body.bundled import bundled_body as bundled_body
