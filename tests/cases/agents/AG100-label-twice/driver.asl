!drive.
@go +!drive : speed(0) <- forward(1); !drive.
@go +!drive <- wait; !drive.
