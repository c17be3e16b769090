"""From labelled markers to limbs, joint centres and one pose per limb and frame."""
