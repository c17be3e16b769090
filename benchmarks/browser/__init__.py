"""What a person waits for in the browser: the report and the viewer."""
