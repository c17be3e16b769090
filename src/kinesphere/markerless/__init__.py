"""Motion without markers: a body's surface fitted to the images of several cameras."""
