"""Normalization and parameterization, step by step, against truth and against the paper."""
