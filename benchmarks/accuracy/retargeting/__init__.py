"""Real walking put on other limb lengths and other rigs: what stays, what slides, what leaps."""
